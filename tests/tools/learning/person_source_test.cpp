#include "tools/learning/person_source.h"

#include <gtest/gtest.h>

#include "recon/body/parts.h"
#include "recon/skeleton.h"

namespace ossa::tools {
namespace {

// Four by two pixels, two of them a left hand and a left foot; joints in a row.
forest::TrainingImage SmallImage() {
  forest::TrainingImage image;
  image.camera = depth::KinectV1Camera(4, 2);
  image.depth_mm = {0, 1500, 0, 0, 1600, 0, 0, 0};
  image.label = {0, 16, 0, 0, 30, 0, 0, 0};
  image.context = 2;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    image.target_m.emplace_back(0.1F * static_cast<float>(j), 1.0F, 2.0F);
    image.target_visible.push_back(j % 3 == 0 ? 1 : 0);
  }
  return image;
}

// Shoulders and hips of a person below the camera whose left points in that direction.
recon::Posture Below(const Eigen::Vector3d& left) {
  recon::Posture joints_m;
  joints_m.position_m.fill({0.0, 0.0, 1.5});
  for (const auto joint : {recon::Joint::kShoulderLeft, recon::Joint::kHipLeft})
    joints_m.position_m[recon::Index(joint)] += 0.2 * left;
  return joints_m;
}

TEST(HeadingSector, IsZeroUpTheImageAndGrowsClockwise) {
  // x grows to the image's left: a person with the left there faces up the image.
  EXPECT_EQ(HeadingSector(Below(Eigen::Vector3d::UnitX())), 0);
  EXPECT_EQ(HeadingSector(Below(Eigen::Vector3d::UnitY())), 2);  // faces right
  EXPECT_EQ(HeadingSector(Below(-Eigen::Vector3d::UnitX())), 4);
  EXPECT_EQ(HeadingSector(Below(-Eigen::Vector3d::UnitY())), 6);
}

TEST(Mirrored, SwapsLeftAndRight) {
  const forest::TrainingImage image = SmallImage();
  const forest::TrainingImage mirrored = Mirrored(image);
  EXPECT_EQ(mirrored.depth_mm, (std::vector<uint16_t>{0, 0, 1500, 0, 0, 0, 0, 1600}));
  EXPECT_EQ(mirrored.label, (std::vector<uint8_t>{0, 0, 17, 0, 0, 0, 0, 31}));
  EXPECT_EQ(mirrored.context, kFacingSectors - 2);
  const auto left = recon::Index(recon::Joint::kHandLeft);
  const auto right = recon::Index(recon::Joint::kHandRight);
  EXPECT_EQ(mirrored.target_m[left].x(), -image.target_m[right].x());
  EXPECT_EQ(mirrored.target_visible[left], image.target_visible[right]);
}

TEST(Mirrored, MirrorsSurfacePoints) {
  const forest::TrainingImage image = SmallImage();
  const forest::TrainingImage mirrored = Mirrored(image);
  const Eigen::Vector3d before = depth::BackProject(image.camera, 1, 0, 1500);
  const Eigen::Vector3d after = depth::BackProject(mirrored.camera, 2, 0, 1500);
  EXPECT_NEAR((after - Eigen::Vector3d(-before.x(), before.y(), before.z())).norm(), 0.0, 1e-12);
}

TEST(Mirrored, TwiceIsTheIdentity) {
  const forest::TrainingImage image = SmallImage();
  const forest::TrainingImage twice = Mirrored(Mirrored(image));
  EXPECT_EQ(twice.depth_mm, image.depth_mm);
  EXPECT_EQ(twice.label, image.label);
  EXPECT_EQ(twice.context, image.context);
  EXPECT_EQ(twice.target_m, image.target_m);
  EXPECT_EQ(twice.target_visible, image.target_visible);
  EXPECT_NEAR(twice.camera.cx, image.camera.cx, 1e-12);
}

// A crop of two by one pixels out of the middle of an image of five by three.
LabelledFrame Crop(const depth::Camera& whole) {
  LabelledFrame frame;
  frame.depth.camera = whole;
  frame.depth.camera.width = 2;
  frame.depth.camera.height = 1;
  frame.depth.camera.cx -= 2;
  frame.depth.camera.cy -= 1;
  frame.depth.depth_mm = {1500, 1600};
  frame.parts = depth::Image<uint8_t>(2, 1);
  frame.parts.data = {16, 30};
  frame.users = depth::Image<uint8_t>(2, 1);
  frame.users.data = {1, 1};
  return frame;
}

TEST(Uncropped, PutsPixelsBackAtTheirSensorPosition) {
  const depth::Camera whole = depth::KinectV1Camera(5, 3);
  const LabelledFrame frame = Uncropped(Crop(whole), whole);
  EXPECT_EQ(frame.depth.camera.cx, whole.cx);
  EXPECT_EQ(frame.depth.camera.cy, whole.cy);
  EXPECT_EQ(frame.depth.depth_mm,
            (std::vector<uint16_t>{0, 0, 0, 0, 0, 0, 0, 1500, 1600, 0, 0, 0, 0, 0, 0}));
  EXPECT_EQ(frame.parts.at(2, 1), 16);
  EXPECT_EQ(frame.users.at(3, 1), 1);
}

TEST(Uncropped, KeepsProjectionsForAnotherCamera) {
  const depth::Camera whole = depth::KinectV1Camera(5, 3);
  LabelledFrame crop = Crop(whole);
  crop.depth.camera.cx -= 40.25;  // would lie outside
  const LabelledFrame frame = Uncropped(crop, whole);
  const Eigen::Vector3d before = depth::BackProject(crop.depth.camera, 0, 0, 1500);
  EXPECT_EQ(frame.depth.view().at(3, 1), 1500);
  const Eigen::Vector3d after = depth::BackProject(frame.depth.camera, 3, 1, 1500);
  EXPECT_NEAR((before - after).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace ossa::tools
