#include "recon/refine/free_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ossa::recon {
namespace {

// A board at 2 m in front of a wall at 4 m: x from 0 to 0.4 m, y from -0.4 to 0.4 m.
depth::DepthFrame BoardBeforeWall() {
  depth::DepthFrame frame;
  frame.camera = depth::KinectV1Camera(320, 240);
  frame.depth_mm.assign(320 * 240, 4000);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d p = depth::BackProject(frame.camera, u, v, 2000.0);
      if (p.x() >= 0.0 && p.x() <= 0.4 && std::abs(p.y()) <= 0.4)
        frame.depth_mm[static_cast<size_t>(v * 320 + u)] = 2000;
    }
  }
  return frame;
}

TEST(MoveOutOfFreeSpace, KeepsHiddenAndVisibleJoints) {
  const depth::DepthFrame frame = BoardBeforeWall();
  for (const Eigen::Vector3d& place :
       {Eigen::Vector3d(0.2, 0.0, 2.03), Eigen::Vector3d(0.2, 0.0, 2.8),
        Eigen::Vector3d(0.2, 0.0, 1.95), Eigen::Vector3d(-1.0, 0.0, 4.05)}) {
    EXPECT_FALSE(IsInFreeSpace(place, frame));
    EXPECT_EQ(MoveOutOfFreeSpace(place, frame), place);
  }
}

// 20 cm beside the board, as far as the board: the nearest place is its edge, and 3 cm within.
TEST(MoveOutOfFreeSpace, MovesJointsInFreeSpaceInsideTheNearestSilhouette) {
  const depth::DepthFrame frame = BoardBeforeWall();
  const Eigen::Vector3d floating(-0.2, 0.1, 2.0);
  ASSERT_TRUE(IsInFreeSpace(floating, frame));
  const Eigen::Vector3d hidden = MoveOutOfFreeSpace(floating, frame);
  EXPECT_FALSE(IsInFreeSpace(hidden, frame));
  // A pixel is 7 mm there and a step of the search a centimetre.
  const double across_m = (hidden - floating).head<2>().norm();
  EXPECT_NEAR(across_m, 0.2 + FreeSpaceOptions{}.inwards_m, 0.02);
  EXPECT_GT(hidden.x(), 0.0);
  EXPECT_NEAR(hidden.z(), 2.0 + FreeSpaceOptions{}.skin_m, 1e-6);
}

// A joint farther than the board moves straight behind it, at its own depth.
TEST(MoveOutOfFreeSpace, KeepsTheDepthOfJointsBehindTheirOccluder) {
  const Eigen::Vector3d hidden = MoveOutOfFreeSpace({-0.1, 0.0, 2.5}, BoardBeforeWall());
  EXPECT_NEAR(hidden.z(), 2.5, 1e-9);
  EXPECT_GT(hidden.x(), 0.0);
}

TEST(MoveOutOfFreeSpace, MovesFloatingJointsBehindTheSurface) {
  const Eigen::Vector3d hidden = MoveOutOfFreeSpace({0.2, 0.0, 1.7}, BoardBeforeWall());
  EXPECT_NEAR(hidden.z(), 2.0 + FreeSpaceOptions{}.skin_m, 1e-6);
  EXPECT_NEAR(hidden.x() / hidden.z(), 0.2 / 1.7, 1e-9) << "along its line of sight";
}

TEST(MoveOutOfFreeSpace, DecidesNothingOutsideTheImageWithoutReadingOrOutOfReach) {
  depth::DepthFrame frame = BoardBeforeWall();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d far_off(-0.6, 0.0, 2.0), outside(9.0, 0.0, 2.0), behind(0.0, 0.0, -1.0);
  EXPECT_TRUE(IsInFreeSpace(far_off, frame));
  for (const auto& place : {far_off, outside, behind})
    EXPECT_EQ(MoveOutOfFreeSpace(place, frame), place);
  EXPECT_TRUE(std::isnan(MoveOutOfFreeSpace({nan, 0.0, 2.0}, frame).x()));
  frame.depth_mm.assign(frame.depth_mm.size(), 0);
  EXPECT_EQ(MoveOutOfFreeSpace({-0.2, 0.1, 2.0}, frame), Eigen::Vector3d(-0.2, 0.1, 2.0));
}

}  // namespace
}  // namespace ossa::recon
