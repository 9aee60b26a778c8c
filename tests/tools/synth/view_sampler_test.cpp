#include "tools/synth/view_sampler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ossa::tools {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(ViewSampler, FrontViewsFaceTheCameraAndHaveThePersonInTheImage) {
  Random random(1, 0);
  int whole = 0;
  for (int i = 0; i < 500; ++i) {
    const ViewSample sample = SampleView({.view = View::kFront}, random);
    EXPECT_LE(std::abs(sample.facing_rad), kPi / 3);
    const Eigen::Vector2d chest =
        Project(sample.camera, sample.camera_from_world * Eigen::Vector3d(0, 1.1, 0));
    EXPECT_TRUE(chest.x() > 0 && chest.x() < 640 && chest.y() > 0 && chest.y() < 480)
        << chest.transpose();
    const Eigen::Vector2d top =
        Project(sample.camera, sample.camera_from_world * Eigen::Vector3d(0, 1.7, 0));
    const Eigen::Vector2d bottom =
        Project(sample.camera, sample.camera_from_world * Eigen::Vector3d(0, 0, 0));
    whole += top.y() > 0 && bottom.y() < 480 ? 1 : 0;
  }
  EXPECT_GT(whole, 250) << "whole bodies must be the rule";
}

TEST(ViewSampler, ImageIsUprightAndAFacingPersonsLeftIsAtTheRight) {
  Random random(2, 0);
  const ViewSample sample = SampleView({.view = View::kFront}, random);
  const auto pixel = [&](double x, double y) {
    return Project(sample.camera, sample.camera_from_world * Eigen::Vector3d(x, y, 0));
  };
  EXPECT_LT(pixel(0, 1.5).y(), pixel(0, 0.5).y());
  // A person with heading 0 faces the camera: the person's left (+x) is at the image's right.
  EXPECT_GT(pixel(0.3, 1.0).x(), pixel(-0.3, 1.0).x());
  EXPECT_NEAR(sample.camera_from_world.linear().determinant(), 1.0, 1e-12);
}

// The bounds of uniform distributions: of 500 draws the extremes are within 1 % of the range.
TEST(ViewSampler, ViewsHaveTheDocumentedDistances) {
  struct Range {
    View view;
    double from_m, to_m;
  };
  Random random(4, 0);
  for (const Range& range : {Range{View::kFront, 1.6, 4.0}, Range{View::kNear, 0.75, 1.7},
                             Range{View::kAny, 0.8, 5.0}}) {
    double nearest_m = 10.0, farthest_m = 0.0;
    for (int i = 0; i < 500; ++i) {
      const ViewSample sample = SampleView({.view = range.view}, random);
      // The person stands at the origin.
      const Eigen::Vector3d camera_m = sample.camera_from_world.inverse().translation();
      const double distance_m = std::hypot(camera_m.x(), camera_m.z());
      nearest_m = std::min(nearest_m, distance_m);
      farthest_m = std::max(farthest_m, distance_m);
    }
    const double slack_m = 0.01 * (range.to_m - range.from_m);
    EXPECT_GE(nearest_m, range.from_m);
    EXPECT_LE(nearest_m, range.from_m + slack_m);
    EXPECT_LE(farthest_m, range.to_m);
    EXPECT_GE(farthest_m, range.to_m - slack_m);
  }
}

TEST(ViewSampler, AnyCoversEverySideAndDistance) {
  Random random(3, 0);
  int backs = 0;
  int far = 0;
  for (int i = 0; i < 400; ++i) {
    const ViewSample sample = SampleView({.view = View::kAny}, random);
    backs += std::abs(sample.facing_rad) > kPi / 2 ? 1 : 0;
    far += (sample.camera_from_world * Eigen::Vector3d(0, 1, 0)).norm() > 2.5 ? 1 : 0;
  }
  // Half of the headings show the back; three standard deviations of a binomial of 400 are 30.
  EXPECT_NEAR(backs, 200, 30);
  EXPECT_GT(far, 60);
}

TEST(ViewSampler, TrainAndTestNeverShareAPlacement) {
  // The same draws under both splits: where train accepts, test must not.
  for (uint64_t seed = 0; seed < 200; ++seed) {
    Random a(seed);
    Random b(seed);
    const ViewSample train = SampleView({.view = View::kAny, .split = Split::kTrain}, a);
    const ViewSample test = SampleView({.view = View::kAny, .split = Split::kTest}, b);
    EXPECT_FALSE(train.camera_from_world.isApprox(test.camera_from_world, 1e-9));
  }
}

TEST(ViewSampler, CeilingCameraIsHighAndLooksDown) {
  Random random(5, 0);
  int straight = 0, upside_down = 0, aside = 0;
  for (int i = 0; i < 300; ++i) {
    const ViewSample sample = SampleView({.view = View::kCeiling}, random);
    const Eigen::Isometry3d world_from_camera = sample.camera_from_world.inverse();
    EXPECT_GE(world_from_camera.translation().y(), 2.2);
    EXPECT_LE(world_from_camera.translation().y(), 4.0);
    const double down = -world_from_camera.linear().col(2).y();
    EXPECT_GT(down, std::cos(36.0 / 180 * std::numbers::pi)) << "the optical axis points down";
    const Eigen::Vector3d middle = sample.camera_from_world * Eigen::Vector3d(0, 0.9, 0);
    EXPECT_GT(middle.z(), 0.5);
    straight += down > 0.985 ? 1 : 0;
    upside_down += world_from_camera.linear()(2, 1) > 0 ? 1 : 0;
    aside += middle.head<2>().norm() > 0.25 * middle.z() ? 1 : 0;
  }
  EXPECT_GT(straight, 50);
  EXPECT_GT(upside_down, 20) << "what hangs straight down hangs there turned anyhow";
  EXPECT_GT(aside, 100) << "people are anywhere in the image";
}

TEST(ViewSampler, AnyCameraCoversSizesAndFieldsOfView) {
  Random random(6, 0);
  int small = 0, large = 0, wide = 0, shrunk = 0;
  for (int i = 0; i < 400; ++i) {
    const ViewSample sample = SampleView({.cameras = Cameras::kAny}, random);
    const depth::Camera camera = ShrunkCamera(sample.camera, sample.shrink);
    const double fov_deg = 2 * std::atan(0.5 * camera.width / camera.fx) * 180 / kPi;
    ASSERT_GE(camera.width, 99);
    ASSERT_LE(sample.camera.width, 1281);
    ASSERT_GT(fov_deg, 44);
    ASSERT_LT(fov_deg, 121);
    small += camera.width < 160 ? 1 : 0;
    large += camera.width > 800 ? 1 : 0;
    wide += fov_deg > 100 ? 1 : 0;
    shrunk += sample.shrink > 1 ? 1 : 0;
  }
  for (const int count : {small, large, wide, shrunk}) EXPECT_GT(count, 40);
}

TEST(ViewSampler, ShrunkCameraProjectsToTheSampledPixel) {
  const depth::Camera large{
      .width = 240, .height = 240, .fx = 285.7, .fy = 285.7, .cx = 119.5, .cy = 119.5};
  const depth::Camera small = ShrunkCamera(large, 2.4);
  EXPECT_EQ(small.width, 100);
  const Eigen::Vector3d point_m(0.3, -0.4, 2.0);
  const Eigen::Vector2d in_large = Project(large, point_m), in_small = Project(small, point_m);
  EXPECT_NEAR((in_small.x() + 0.5) * 2.4 - 0.5, in_large.x(), 1e-9);
}

}  // namespace
}  // namespace ossa::tools
