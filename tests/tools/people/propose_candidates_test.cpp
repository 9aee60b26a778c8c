// Proposing candidates by shape and tracks alone.
#include "tools/people/propose_candidates.h"

#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

TEST(ProposeCandidates, PersonIsOneRegionWithoutTheRoom) {
  const CapsuleRender render = Shot({PersonAt(0, 2.5)});
  const Proposed proposed = ProposeAlone(render);
  ASSERT_EQ(proposed.candidates.size(), 1U);
  const auto [person, candidate] = MeasureCover(render, proposed.candidates[0], 1);
  EXPECT_GT(person, 0.9);  // the soles are within the floor's tolerance
  EXPECT_GT(candidate, 0.97);
}

TEST(ProposeCandidates, EmptyRoomGivesNone) {
  EXPECT_TRUE(ProposeAlone(Shot({})).candidates.empty());
}

TEST(ProposeCandidates, TableTopIsNotMergedWithThePersonAtIt) {
  const tests::Box top{{-0.7, -0.30, 2.0}, {0.7, -0.25, 2.45}};
  const CapsuleRender render = Shot({PersonAt(0, 2.6)}, 0, {top});
  double best = 0;
  for (const Candidate& candidate : ProposeAlone(render).candidates)
    best = std::max(best, MeasureCover(render, candidate, 1).second);
  EXPECT_GT(best, 0.85);  // an edge of the top may stay
}

TEST(ProposeCandidates, TwoTouchingPeopleAreSplitAtTheirHeads) {
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)});
  const Proposed proposed = ProposeAlone(render);
  ASSERT_EQ(proposed.candidates.size(), 2U);
  EXPECT_EQ(proposed.candidates[0].region_index, proposed.candidates[1].region_index);
  for (const Candidate& candidate : proposed.candidates) {
    const double best = std::max(MeasureCover(render, candidate, 1).second,
                                 MeasureCover(render, candidate, 2).second);
    EXPECT_GT(best, 0.85);  // the touching hands may go either way
  }
}

// A flat coat that moves into the plane of a cupboard's front, half a metre beside it.
TEST(ProposeCandidates, TrackedPersonStaysWholeInThePlaneOfACupboard) {
  constexpr double kFront_m = 3.0;
  const tests::Box cupboard{{0.5, -1.0, kFront_m}, {1.7, 0.8, 3.4}};
  PeopleState state;
  for (int f = 0; f < 6; ++f) {
    const double z_m = std::min(kFront_m, 2.9 + 0.03 * f);
    const tests::Box coat{{-0.35, -0.8, z_m}, {0.0, 0.6, z_m + 0.2}};
    const CapsuleRender render = Shot({}, f, {cupboard, coat});
    const Proposed proposed = Propose(render, state);
    ASSERT_EQ(proposed.candidates.size(), 1U) << f;
    EXPECT_GT(proposed.candidates[0].region.area_m2, 0.9F * 0.35F * 1.4F) << f;
    Confirm(proposed, proposed.candidates, render.frame.time_s, state);
  }
}

// The surface of the track's candidate, square metres, after somebody with this score stood before
// `first` for a second and is then seen in `last`.
float TrackAreaAfter_m2(double score, const std::vector<tests::Box>& first,
                        const std::vector<tests::Box>& last) {
  constexpr int kEmpty = 25, kFrames = 30;  // the room alone becomes background
  PeopleState state;
  for (int f = 0; f < kEmpty; ++f) Confirm(Propose(Shot({}, f), state), {}, f / 30.0, state);
  for (int f = kEmpty; f < kEmpty + kFrames; ++f) {
    const CapsuleRender render = Shot({}, f, first);
    const Proposed proposed = Propose(render, state);
    EXPECT_EQ(proposed.candidates.size(), 1U) << f;
    Confirm(proposed, proposed.candidates, render.frame.time_s, state, {}, score);
  }
  float area_m2 = 0;
  const Proposed proposed = Propose(Shot({}, kEmpty + kFrames, last), state);
  for (const Candidate& candidate : proposed.candidates)
    if (candidate.track == 0) area_m2 += candidate.region.area_m2;
  return area_m2;
}

// A flat coat whose front meets that of a cupboard without a gap: one plane, larger than a person.
TEST(ProposeCandidates, PersonForSureIsNotPartOfThePlaneThatGrowsOverThem) {
  const tests::Box coat{{-0.35, -0.8, 3.0}, {0.0, 0.6, 3.2}};
  const tests::Box cupboard{{0.0, -1.0, 3.0}, {1.2, 0.8, 3.4}};
  constexpr float kCoat_m2 = 0.35F * 1.4F;
  EXPECT_NEAR(TrackAreaAfter_m2(0.9, {coat}, {coat, cupboard}), kCoat_m2, 0.1F * kCoat_m2);
  EXPECT_EQ(TrackAreaAfter_m2(0.3, {coat}, {coat, cupboard}), 0.0F);
}

TEST(ProposeCandidates, PersonInAKnownRoomIsHardlyBackground) {
  PeopleState state;
  const Proposed first = Propose(Shot({PersonAt(0, 2.5)}), state);
  ASSERT_EQ(first.candidates.size(), 1U);
  EXPECT_EQ(first.candidates[0].background_share, 1.0) << "the room is not known";
  state = {};
  for (int f = 0; f < 5; ++f) Confirm(Propose(Shot({}, f), state), {}, f / 30.0, state);
  const Proposed entered = Propose(Shot({PersonAt(0, 2.5)}, 5), state);
  ASSERT_EQ(entered.candidates.size(), 1U);
  EXPECT_LT(entered.candidates[0].background_share, 0.1);
}

TEST(ProposeCandidates, OnlyWhoScoredLikeAPersonMayReturn) {
  const auto may_return = [](double score) {
    PeopleState state;
    for (int f = 0; f < 5; ++f) {
      const CapsuleRender render = Shot({PersonAt(0, 2.5)}, f);
      const Proposed proposed = Propose(render, state);
      Confirm(proposed, proposed.candidates, render.frame.time_s, state, {}, score);
    }
    Confirm(Propose(Shot({}, 12), state), {}, 12 / 30.0, state);
    const Proposed back = Propose(Shot({PersonAt(0.6, 2.5)}, 13), state);
    EXPECT_EQ(back.candidates.size(), 1U);
    return !back.candidates.at(0).may_return_as.empty();
  };
  EXPECT_TRUE(may_return(0.9));
  EXPECT_FALSE(may_return(0.4));
}

// Half of a body on the floor is in one large plane with what lies beside it.
TEST(ProposeCandidates, PersonForSureOnTheFloorKeepsWhatStandsOutBesideThem) {
  const tests::Box trunk{{-0.6, -1.0, 2.6}, {0.0, -0.7, 2.9}};
  const tests::Box legs{{0.0, -1.0, 2.6}, {0.7, 0.0, 2.9}};  // 0.7 m2: flatter than a body
  constexpr float kTrunk_m2 = 0.6F * 0.3F;
  EXPECT_GT(TrackAreaAfter_m2(0.9, {trunk}, {trunk, legs}), 1.5F * kTrunk_m2);
  EXPECT_LT(TrackAreaAfter_m2(0.3, {trunk}, {trunk, legs}), 1.1F * kTrunk_m2);
}

// Seen from 3 m above the floor: head, trunk and an arm down to the left, with the hand at the
// middle of a roll on the floor, 4 m long.
CapsuleRender AtARollFromAbove() {
  CapsuleScene scene;
  scene.capsules = {{{0, 0, 1.35}, {0, 0, 1.4}, 0.11},
                    {{0, 0, 1.72}, {0, 0.02, 2.2}, 0.17},
                    {{0.15, 0, 1.62}, {0.75, 0, 2.6}, 0.05},
                    {{0.95, -2.0, 2.75}, {0.95, 2.0, 2.75}, 0.15}};
  scene.planes = {{-Eigen::Vector3d::UnitZ(), 3.0}};
  return tests::Render(scene, KinectV1Camera(320, 240));
}

// The largest horizontal distance of a candidate's cells from its head, metres.
std::vector<float> ReachesFromAbove(const PeopleOptions& options) {
  PeopleState state;
  const Proposed proposed = Propose(AtARollFromAbove(), state, options);
  std::vector<float> reaches_m;
  for (const Candidate& candidate : proposed.candidates) {
    if (!candidate.has_head) continue;
    float farthest_m = 0;
    for (const int cell : candidate.region.cells)
      farthest_m = std::max(farthest_m, proposed.scene.grid.at(cell).head<2>().norm());
    reaches_m.push_back(farthest_m);
  }
  return reaches_m;
}

TEST(ProposeCandidates, FromAboveAPersonTouchingALongObjectIsCutAtReach) {
  PeopleOptions options = PeopleOptionsFromAbove();
  const auto reaches_m = ReachesFromAbove(options);
  ASSERT_EQ(reaches_m.size(), 1U);
  EXPECT_GT(reaches_m[0], 0.75F) << "the hand is theirs";
  EXPECT_LE(reaches_m[0], options.candidates.overhead->reach_m + 0.05F) << "all of the roll is not";
}

TEST(MergeCandidates, UndoesASplit) {
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)});
  const Proposed proposed = ProposeAlone(render);
  ASSERT_EQ(proposed.candidates.size(), 2U);
  const Candidate& a = proposed.candidates[0];
  const Candidate& b = proposed.candidates[1];
  const Candidate whole = MergeCandidates(proposed.scene, render.frame, a, b);
  EXPECT_EQ(whole.region.cells.size(), a.region.cells.size() + b.region.cells.size());
  // At the seam a pixel may have belonged to both or to neither.
  EXPECT_NEAR(static_cast<double>(whole.pixels.size()),
              static_cast<double>(a.pixels.size() + b.pixels.size()), 60.0);
}

// Shares are means over cells, areas add up, and flags of either hold for both.
TEST(MergeCandidates, SharesAreWeighedByTheirCells) {
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)});
  const Proposed proposed = ProposeAlone(render);
  ASSERT_EQ(proposed.candidates.size(), 2U);
  Candidate a = proposed.candidates[0], b = proposed.candidates[1];
  std::erase_if(a.region.cells, [n = 0](int) mutable { return n++ % 3 != 0; });
  a.flat_share = a.foreground_share = a.occluded_share = 1.0;
  b.flat_share = b.foreground_share = b.occluded_share = 0.25;
  a.foreground_m2 = 0.25F;
  b.foreground_m2 = 0.5F;
  a.isolated = false;
  b.isolated = a.has_head = true;
  b.has_head = false;
  b.track = 3;
  b.may_return_as = {1};
  const Candidate whole = MergeCandidates(proposed.scene, render.frame, a, b);
  const auto cells_a = static_cast<double>(a.region.cells.size());
  const auto cells_b = static_cast<double>(b.region.cells.size());
  const double expected = (cells_a + 0.25 * cells_b) / (cells_a + cells_b);
  EXPECT_NEAR(whole.flat_share, expected, 1e-12);
  EXPECT_NEAR(whole.foreground_share, expected, 1e-12);
  EXPECT_NEAR(whole.occluded_share, expected, 1e-12);
  EXPECT_EQ(whole.foreground_m2, 0.75F);
  EXPECT_FALSE(whole.isolated);
  EXPECT_TRUE(whole.has_head);
  EXPECT_EQ(whole.track, 3);
  EXPECT_EQ(whole.may_return_as, std::vector<int>{1});
}

TEST(MeetAlongRim, IsTrueForHalvesOfAPersonAndFalseForSeparatePeople) {
  const Proposed proposed = ProposeAlone(Shot({PersonAt(-0.6, 2.5), PersonAt(0.6, 2.5)}));
  ASSERT_EQ(proposed.candidates.size(), 2U);
  const Candidate& person = proposed.candidates[0];
  std::vector<int> upper, lower;
  for (const int cell : person.region.cells)
    (proposed.scene.grid.at(cell).y() > 0 ? upper : lower).push_back(cell);
  Candidate above, below;
  above.region = MakeRegion(proposed.scene.grid, upper);
  below.region = MakeRegion(proposed.scene.grid, lower);
  EXPECT_TRUE(MeetAlongRim(proposed.scene, above, below, {}));
  EXPECT_FALSE(MeetAlongRim(proposed.scene, person, proposed.candidates[1], {}));
}

// A candidate that appears beside a tracked person.
Candidate NewBeside(float apart_m) {
  PeopleState state;
  const auto see = [&](const CapsuleRender& render, bool people) {
    const Proposed proposed = Propose(render, state);
    Confirm(proposed, people ? proposed.candidates : std::vector<Candidate>{}, render.frame.time_s,
            state);
  };
  CapsulePose person = PersonAt(0, 2.5);
  person.left_lift_rad = person.right_lift_rad = 3.0;  // out of the way
  see(Shot({}, 0), false);
  see(Shot({person}, 1), true);
  const double x_m = static_cast<double>(apart_m);
  const tests::Box thing{{x_m - 0.08, -0.8, 2.5}, {x_m + 0.08, 0.2, 2.6}};
  const CapsuleRender render = Shot({person}, 2, {thing});
  for (const Candidate& candidate : Propose(render, state).candidates) {
    if (candidate.track < 0) return candidate;
  }
  ADD_FAILURE() << "nothing new";
  return {};
}

TEST(ProposeCandidates, NewCandidateBesideATrackedPersonMayBeAPartOfIt) {
  EXPECT_EQ(NewBeside(0.4F).foreground_share, 0.0);
  EXPECT_GT(NewBeside(0.9F).foreground_share, 0.9);
  // The centroids are 8 cm of the object and some 20 cm of the person away from their sides.
  EXPECT_FALSE(NewBeside(0.9F).isolated);
  EXPECT_TRUE(NewBeside(1.1F).isolated);
}

// Of who holds a board before the chest little more than head and shoulders is visible, in one
// frame a little less.
TEST(ProposeCandidates, TrackedPersonOfWhomLittleIsVisibleStays) {
  const auto board = [](double width_m) {
    return tests::Box{{0.0, 0.0, 2.0}, {width_m, 0.3, 2.1}};
  };
  PeopleState state;
  const CapsuleRender before = Shot({}, 0, {board(0.27)}), now = Shot({}, 1, {board(0.21)});
  const Proposed first = Propose(before, state);
  ASSERT_EQ(first.candidates.size(), 1U);
  EXPECT_GE(first.candidates[0].region.area_m2, CandidateOptions{}.min_area_m2);
  EXPECT_TRUE(ProposeAlone(now).candidates.empty());
  Confirm(first, first.candidates, before.frame.time_s, state);
  const Proposed second = Propose(now, state);
  ASSERT_EQ(second.candidates.size(), 1U);
  EXPECT_EQ(second.candidates[0].track, 0);
}

// A plane that grew over somebody flat before a wall takes them from no track that scored like a
// person.
TEST(ProposeCandidates, NoPlaneGrowsOverAPerson) {
  const auto is_found = [](double score) {
    PeopleState state;
    const Proposed before = Propose(Shot({PersonAt(0, 2.5)}, 0), state);
    EXPECT_EQ(before.candidates.size(), 1U);
    Confirm(before, before.candidates, 0.0, state, {}, score);
    const CapsuleRender render = Shot({PersonAt(0, 2.5)}, 1);
    Scene scene = Propose(render, state).scene;
    for (const int cell : before.candidates.at(0).region.cells)
      scene.surfaces.room[static_cast<size_t>(cell)] = 1;
    const PeopleOptions options;
    const auto now = ProposeCandidates(render.frame, scene, state.tracks.tracks,
                                       options.association.reidentify, options.candidates);
    return std::any_of(now.candidates.begin(), now.candidates.end(),
                       [](const Candidate& candidate) { return candidate.track == 0; });
  };
  EXPECT_TRUE(is_found(0.8));
  EXPECT_FALSE(is_found(0.5));
}

}  // namespace
}  // namespace ossa::people
