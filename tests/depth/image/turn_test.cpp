#include "depth/image/turn.h"

#include <gtest/gtest.h>

namespace ossa::depth {
namespace {

// An image with its centre off the middle, one pixel of which differs.
DepthFrame Marked() {
  DepthFrame frame;
  frame.camera = {8, 6, 10, 11, 3.25, 2.5};
  frame.depth_mm.assign(48, 1000);
  frame.depth_mm[6 + 8 * 1] = 2000;  // (6, 1): right above
  return frame;
}

class QuarterTurns : public testing::TestWithParam<int> {};

TEST_P(QuarterTurns, KeepThePositionOfPoints) {
  const DepthFrame frame = Marked(), turned = Turned(frame, GetParam());
  const auto at = std::find(turned.depth_mm.begin(), turned.depth_mm.end(), 2000);
  ASSERT_NE(at, turned.depth_mm.end());
  const auto place = at - turned.depth_mm.begin();
  const double u = static_cast<double>(place % turned.camera.width);
  const double v = static_cast<double>(place / turned.camera.width);
  const Eigen::Vector3d back =
      CameraFromTurned(GetParam()) * BackProject(turned.camera, u, v, 2000);
  EXPECT_TRUE(back.isApprox(BackProject(frame.camera, 6, 1, 2000), 1e-12)) << back.transpose();
}

TEST_P(QuarterTurns, AreInvertedByTheRemainingTurns) {
  const DepthFrame frame = Marked();
  const DepthFrame back = Turned(Turned(frame, GetParam()), (4 - GetParam()) % 4);
  EXPECT_EQ(back.depth_mm, frame.depth_mm);
  EXPECT_EQ(back.camera, frame.camera);
}

INSTANTIATE_TEST_SUITE_P(All, QuarterTurns, testing::Values(0, 1, 2, 3));

// A mirror's camera sees a point at u = cx + fx x/z.
TEST(Unmirrored, MirrorsPoints) {
  const DepthFrame mirrored = Marked(), frame = Unmirrored(mirrored);
  EXPECT_EQ(frame.depth_mm[1 + 8 * 1], 2000);
  const Eigen::Vector3d point = BackProject(frame.camera, 1, 1, 2000);
  const Camera& mirror = mirrored.camera;
  EXPECT_NEAR(mirror.cx + mirror.fx * point.x() / point.z(), 6.0, 1e-12);
  const DepthFrame again = Unmirrored(frame);
  EXPECT_EQ(again.depth_mm, mirrored.depth_mm);
  EXPECT_EQ(again.camera, mirrored.camera);
}

TEST(Unmirrored, DoesNotChangeABorrowedImage) {
  DepthFrame owner = Marked();
  DepthFrame part = owner;
  part.depth_mm.clear();
  part.borrowed = {owner.depth_mm.data() + 4, 4, 6, 8};  // its right half
  part.camera.width = 4;
  EXPECT_EQ(Unmirrored(part).depth_mm[1 + 4 * 1], 2000);
  EXPECT_EQ(owner.depth_mm, Marked().depth_mm);
}

TEST(QuarterTurn, IsClockwise) {
  const DepthFrame turned = Turned(Marked(), 1);
  EXPECT_EQ(turned.camera.width, 6);
  EXPECT_EQ(turned.depth_mm[4 + 6 * 6], 2000);  // right above goes right below
}

}  // namespace
}  // namespace ossa::depth
