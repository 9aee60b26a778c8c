#include "tools/nite2/hands.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tools/nite2/lone_hands.h"

namespace ossa::nite2 {
namespace {

constexpr int kWidth = 320, kHeight = 240;
constexpr double kFrame_s = 1.0 / 30;

SeenHand HandOf(int body_id, bool left, const Eigen::Vector3d& place_m) {
  return {body_id, left, {0.0, place_m, place_m, place_m}};
}

// One step of a hand asked for at (0, 0, 1): its state.
int StateAfter(FollowedHands& hands, const std::vector<SeenHand>& seen, double time_s) {
  const depth::Camera camera{kWidth, kHeight, 287.5, 287.5, 160, 120};
  const auto all = hands.Step(seen, time_s, camera, 0.0F, false);
  return all.empty() ? -1 : static_cast<int>(all.front().state);
}

TEST(FollowedHands, ContinueAsTheirBodyEntersAndLeavesTheView) {
  FollowedHands hands;
  hands.Start({0, 0, 1});
  EXPECT_EQ(StateAfter(hands, {HandOf(-1, false, {0, 0, 1})}, 0), NITE_HAND_STATE_NEW);
  EXPECT_EQ(StateAfter(hands, {HandOf(3, true, {0.1, 0, 1})}, kFrame_s), NITE_HAND_STATE_TRACKED);
  EXPECT_EQ(StateAfter(hands, {HandOf(-2, false, {0.1, 0.1, 1})}, 2 * kFrame_s),
            NITE_HAND_STATE_TRACKED);
  EXPECT_EQ(StateAfter(hands, {HandOf(-2, false, {0.1, 0.1, 1})}, 1.0), NITE_HAND_STATE_TRACKED);
}

TEST(FollowedHands, AreNotConfusedWithOtherHands) {
  FollowedHands hands;
  hands.Start({0, 0, 1});
  StateAfter(hands, {HandOf(3, true, {0, 0, 1})}, 0);
  const std::vector<SeenHand> others{HandOf(3, false, {0, 0, 1}), HandOf(4, true, {0, 0, 1})};
  EXPECT_EQ(StateAfter(hands, others, kFrame_s), NITE_HAND_STATE_TRACKED);
  EXPECT_EQ(StateAfter(hands, others, 1.0), NITE_HAND_STATE_LOST);
}

// A forearm 8 cm wide that comes in from below at 1 m, a wall at 1.4 m behind it.
depth::DepthFrame ForearmBeforeAWall() {
  depth::DepthFrame frame;
  frame.camera = {kWidth, kHeight, 287.5, 287.5, 160, 120};
  frame.depth_mm.assign(size_t{kWidth} * kHeight, 1400);
  for (size_t v = 100; v < kHeight; ++v) {
    for (size_t u = 148; u < 171; ++u) frame.depth_mm[v * kWidth + u] = 1000;
  }
  return frame;
}

TEST(LoneHands, AreFoundAtTheFreeEndsOfArms) {
  LoneHands hands;
  const auto seen = hands.Step(ForearmBeforeAWall(), {}, {}, {});
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_LT(seen[0].body_id, 0);
  EXPECT_LT((seen[0].sample.hand_m - Eigen::Vector3d(0, 0, 1)).norm(), 0.06);
  EXPECT_LT(seen[0].sample.elbow_m.y(), -0.2);
}

TEST(LoneHands, AreNotFoundOnUsersOrAtABodysHand) {
  tracker::BodyFrame bodies;
  bodies.users = depth::Image<uint8_t>(kWidth, kHeight);
  std::fill(bodies.users.data.begin(), bodies.users.data.end(), uint8_t{1});
  EXPECT_TRUE(LoneHands().Step(ForearmBeforeAWall(), bodies, {}, {}).empty());
  EXPECT_TRUE(
      LoneHands().Step(ForearmBeforeAWall(), {}, {HandOf(1, true, {0.1, 0, 1})}, {}).empty());
}

TEST(LoneHands, AreNotFoundOnAWall) {
  depth::DepthFrame wall = ForearmBeforeAWall();
  std::fill(wall.depth_mm.begin(), wall.depth_mm.end(), uint16_t{1000});
  EXPECT_TRUE(LoneHands().Step(wall, {}, {}, {Eigen::Vector3d(0, 0, 1)}).empty());
}

}  // namespace
}  // namespace ossa::nite2
