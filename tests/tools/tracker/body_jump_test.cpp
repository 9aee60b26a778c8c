// Implausible jumps between two frames are not returned, though they are observed.
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

TEST(BodyJump, OneFrameJumpIsSuppressed) {
  OSSA_NEEDS_MODEL();
  constexpr double kJump_m = 0.4;
  Tracker tracker;
  BodyFrame before, jump, after;
  for (int f = 0; f < 8; ++f) before = tracker.Track(Rendered({PersonAt(0.0, 2.5)}, f).frame);
  jump = tracker.Track(Rendered({PersonAt(kJump_m, 2.5)}, 8).frame);
  after = tracker.Track(Rendered({PersonAt(0.0, 2.5)}, 9).frame);
  ASSERT_EQ(jump.bodies.size(), 1U);
  ASSERT_EQ(jump.bodies[0].id, before.bodies[0].id);
  ASSERT_GT(std::abs(jump.bodies[0].position_m.x()), 0.5 * kJump_m);  // it is observed
  const auto head = recon::Joint::kHead;
  const double was_m = before.bodies[0].joints[head].position_m.x();
  // Unseen joints are moved out of visible free space.
  EXPECT_NEAR(jump.bodies[0].joints[head].position_m.x(), was_m, 0.3 * kJump_m);
  EXPECT_NE(jump.bodies[0].joints[head].state, recon::TrackingState::kTracked);
  EXPECT_NEAR(after.bodies[0].joints[head].position_m.x(), was_m, 0.05);
  EXPECT_EQ(after.bodies[0].joints[head].state, recon::TrackingState::kTracked);
}

}  // namespace
}  // namespace ossa::tracker
