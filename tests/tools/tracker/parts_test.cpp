// BodyFrame::parts: a body part for each pixel of each user, when asked for.
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/frame_parts_internal.h"

namespace ossa::tracker {
namespace {

TrackerOptions WithParts() {
  TrackerOptions options = PlainOptions();
  options.keep_parts = true;
  return options;
}

TEST(BodyParts, CoverExactlyTheUsersPixels) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(-0.5, 2.3), PersonAt(0.6, 2.8)});
  const BodyFrame bodies = Tracker(WithParts()).Track(render.frame);
  ASSERT_EQ(bodies.bodies.size(), 2U);
  ASSERT_EQ(bodies.parts.data.size(), bodies.users.data.size());
  for (size_t i = 0; i < bodies.parts.data.size(); ++i) {
    ASSERT_EQ(bodies.parts.data[i] != 0, bodies.users.data[i] != 0) << "pixel " << i;
  }
}

// A person of capsules is not what the forest was trained on and its parts have borders of their
// own, so that no more than most of the labels can agree; of 31 a guess would hit some 5 %.
TEST(BodyParts, MostlyMatchTheTruth) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.0, 2.5)});
  const BodyFrame bodies = Tracker(WithParts()).Track(render.frame);
  int both = 0, same = 0;
  for (size_t i = 0; i < render.part.data.size(); ++i) {
    if (render.part.data[i] == 0 || bodies.parts.data[i] == 0) continue;
    ++both;
    same += render.part.data[i] == bodies.parts.data[i] ? 1 : 0;
  }
  EXPECT_GT(both, 1000);
  EXPECT_GT(same, 0.6 * both);
}

TEST(BodyParts, AreClearedForAWithdrawnPerson) {
  BodyFrame frame;
  frame.users = depth::Image<uint8_t>(3, 1);
  frame.users.data = {1, 2, 0};
  frame.parts = depth::Image<uint8_t>(3, 1);
  frame.parts.data = {7, 8, 0};
  frame.probabilities = {3, 1, 2, {0.3F, 0.7F, 0.4F, 0.6F, 0, 0}};
  ClearParts(1, frame);
  EXPECT_EQ(frame.parts.data, (std::vector<uint8_t>{0, 8, 0}));
  EXPECT_EQ(frame.probabilities.data, (std::vector<float>{0, 0, 0.4F, 0.6F, 0, 0}));
}

// Who asks for a picture gets the same skeleton as who does not; near enough that joints are found
// on every second pixel only.
TEST(BodyParts, DoNotChangeTheJoints) {
  OSSA_NEEDS_MODEL();
  const auto render = Rendered({PersonAt(0.0, 1.1)});
  const BodyFrame with = Tracker(WithParts()).Track(render.frame);
  const BodyFrame without = Tracker(PlainOptions()).Track(render.frame);
  ASSERT_EQ(with.bodies.size(), 1U);
  ASSERT_EQ(without.bodies.size(), 1U);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    EXPECT_EQ(with.bodies[0].raw.posture.position_m[j], without.bodies[0].raw.posture.position_m[j])
        << j;
    EXPECT_EQ(with.bodies[0].raw.confidence[j], without.bodies[0].raw.confidence[j]) << j;
  }
}

}  // namespace
}  // namespace ossa::tracker
