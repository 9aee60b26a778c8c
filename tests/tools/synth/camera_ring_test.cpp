#include "tools/synth/camera_ring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "depth/base/angles.h"
#include "recon/motion/mocap.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/frame_maker.h"
#include "tools/synth/sequence_poses.h"

namespace ossa::tools {
namespace {

// Three metres before the origin, a metre up, level.
Eigen::Isometry3d CameraFromWorld() {
  Eigen::Isometry3d world_from_camera = Eigen::Isometry3d::Identity();
  world_from_camera.linear() =
      Eigen::AngleAxisd(180.0 * kDegree, Eigen::Vector3d::UnitY()).toRotationMatrix();
  world_from_camera.translation() = Eigen::Vector3d(0.0, 1.0, 3.0);
  return world_from_camera.inverse();
}

// About the world's vertical, of a camera's place, from z towards x.
double Azimuth_deg(const Eigen::Isometry3d& camera_from_world) {
  const Eigen::Vector3d place_m = camera_from_world.inverse().translation();
  return std::atan2(place_m.x(), place_m.z()) / kDegree;
}

TEST(PlaceCameras, SpreadsThemEvenlyOnTheSideThatThePersonFaces) {
  const std::vector<Eigen::Vector3d> one = {Eigen::Vector3d::Zero()};
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const double side = seed % 2 == 0 ? 1.0 : -1.0;
    const auto cameras = PlaceCameras(CameraFromWorld(), one, side * 0.3, 3, seed);
    ASSERT_EQ(cameras.size(), 3u);
    EXPECT_TRUE(cameras[0].isApprox(CameraFromWorld(), 0.0));
    const double arc_deg = side * Azimuth_deg(cameras[2]);
    EXPECT_GE(arc_deg, 60.0);
    EXPECT_LE(arc_deg, 120.0);
    EXPECT_NEAR(side * Azimuth_deg(cameras[1]), 0.5 * arc_deg, 1e-9);
    // As far from the person as camera 0, who is in the middle of their images, too.
    EXPECT_LT((cameras[2] * Eigen::Vector3d(0, 1, 0) - Eigen::Vector3d(0, 0, 3)).norm(), 1e-9);
  }
}

TEST(PlaceCameras, MovesBackFromPeopleInTheWay) {
  const std::vector<Eigen::Vector3d> ring = {
      Eigen::Vector3d::Zero(), {2.5, 0, 0}, {2.0, 0, 1.5}, {2.0, 0, -1.5}};
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const auto cameras = PlaceCameras(CameraFromWorld(), ring, 0.1, 2, seed);
    const Eigen::Vector3d place_m = cameras[1].inverse().translation();
    EXPECT_EQ(place_m.y(), 1.0);
    for (const Eigen::Vector3d& person_m : ring) {
      EXPECT_GE((place_m - person_m - Eigen::Vector3d::UnitY()).norm(), 1.5 - 1e-9);
    }
  }
}

TEST(FrameMaker, RendersTheSamePeopleForEachCamera) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  FrameOptions options;
  options.width = 64;
  options.height = 48;
  options.sequence = true;
  options.background = Background::kRoom;
  options.people = 2;
  options.views = 2;
  FrameInputs inputs(LoadFetchedBody(), SequencePoses(recon::LoadMocap({"authored"}), 30, 4),
                     options);
  std::vector<LabelledFrame> seen;
  for (const int camera : {0, 1}) {
    inputs.options.camera = camera;
    seen.push_back(FrameMaker(inputs).Make(20));
  }
  const Eigen::Isometry3d from_camera_0 = FrameMaker(inputs).FromCamera0().at(1);
  ASSERT_EQ(seen[1].bodies.size(), 2u);
  for (size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(seen[1].bodies[b].id, seen[0].bodies[b].id);
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const Eigen::Vector3d moved_m = from_camera_0 * seen[0].bodies[b].joints_m.position_m[j];
      // Feet are put on the floor by vertices of four bytes.
      EXPECT_LT((seen[1].bodies[b].joints_m.position_m[j] - moved_m).norm(), 1e-5);
    }
  }
  EXPECT_EQ(seen[0].depth.time_s, seen[1].depth.time_s);
  EXPECT_NE(seen[0].depth.depth_mm, seen[1].depth.depth_mm);
}

}  // namespace
}  // namespace ossa::tools
