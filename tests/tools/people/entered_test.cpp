// People who entered a known room, and the furniture in it.
#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

// A person-sized box, part of the background, that a person passed on the way out of view.
TEST(EnteredPerson, DoesNotContinueInKnownFurniture) {
  const tests::Box box{{-0.17, -0.95, 3.0}, {0.17, 0.5, 3.2}};
  PeopleState state;
  const Proposed before = Propose(Shot({}, 0, {box}), state);
  ASSERT_EQ(before.candidates.size(), 1U);
  Confirm(before, {}, 0.0, state);
  Track track;
  track.id = 1;
  track.cells = before.candidates[0].region.cells;
  for (const int cell : track.cells) track.z_m.push_back(before.scene.grid.z(cell));
  // Last seen together with the box, no part of which entered.
  for (const bool entered : {false, true}) {
    track.entered = entered;
    PeopleState followed = state;
    followed.tracks.tracks = {track};
    const Proposed now = Propose(Shot({}, 1, {box}), followed);
    ASSERT_EQ(now.candidates.size(), 1U);
    EXPECT_EQ(now.candidates[0].track, entered ? -1 : 0);
  }
}

TEST(EnteredPerson, StaysEnteredWhenItsSegmentIncludesFurniture) {
  PeopleState state;
  for (int f = 0; f < 2; ++f) {
    const Proposed proposed = Propose(Shot({PersonAt(0, 2.5)}, f), state);
    ASSERT_EQ(proposed.candidates.size(), 1U);
    Candidate person = proposed.candidates[0];
    person.foreground_share = f == 0 ? 0.9 : 0.2;
    Confirm(proposed, {person}, f / 30.0, state);
    ASSERT_EQ(state.tracks.tracks.size(), 1U);
    EXPECT_TRUE(state.tracks.tracks[0].entered);
  }
}

// A person walks up to a known box and stays at it: the person's share of their segment.
double MeasureShareOfPersonAtABox(bool entered) {
  const tests::Box box{{-0.3, -0.5, 2.45}, {-0.05, 0.3, 2.7}};
  PeopleState state;
  double share = 0;
  for (int f = 0; f < 30; ++f) {
    CapsulePose pose = PersonAt(f < 13 ? 0.9 - 0.06 * f : 0.16, 2.6);
    pose.left_lift_rad = pose.right_lift_rad = 0.1;
    const CapsuleRender render =
        Shot(f < 4 ? std::vector<CapsulePose>{} : std::vector{pose}, f, {box});
    const Proposed proposed = Propose(render, state);
    std::vector<Candidate> people;
    for (const Candidate& candidate : proposed.candidates) {
      double theirs = 0;
      for (const int32_t pixel : candidate.pixels)
        theirs += render.person.data[static_cast<size_t>(pixel)] > 0 ? 1 : 0;
      theirs /= static_cast<double>(candidate.pixels.size());
      if (candidate.track < 0 && theirs < 0.5) continue;
      people.push_back(candidate);
      share = theirs;
    }
    Confirm(proposed, people, render.frame.time_s, state);
    for (Track& track : state.tracks.tracks) track.entered = entered;
  }
  return share;
}

TEST(EnteredPerson, DoesNotSpreadIntoTouchedFurniture) {
  EXPECT_GT(MeasureShareOfPersonAtABox(true), 0.85);
  EXPECT_LT(MeasureShareOfPersonAtABox(false),
            0.8);  // without tracks the box may belong to the person
}

}  // namespace
}  // namespace ossa::people
