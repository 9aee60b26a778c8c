// Association of people with tracks.
#include "tools/people/associate_tracks.h"

#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

class Identity : public testing::Test {
 protected:
  // All candidates count as people; ids from left to right of the sensor (falling x).
  std::vector<int> See(const CapsuleRender& render) {
    const Proposed proposed = Propose(render, state_);
    std::vector<Candidate> people = proposed.candidates;
    std::sort(people.begin(), people.end(), [](const Candidate& a, const Candidate& b) {
      return a.region.mean_m.x() > b.region.mean_m.x();
    });
    return Confirm(proposed, people, render.frame.time_s, state_);
  }
  std::vector<Track>& tracks() { return state_.tracks.tracks; }
  PeopleState state_;
};

TEST_F(Identity, StaysWhileAPersonWalks) {
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(See(Shot({PersonAt(-0.5 + 0.05 * i, 2.5)}, i)), std::vector<int>{1}) << i;
}

TEST_F(Identity, IsKeptWhenTwoPeoplePassEachOther) {
  // At two metres per second and a metre apart: for a moment the farther one is occluded.
  std::vector<int> ids, first;
  for (int i = 0; i <= 30; ++i) {
    const double x_m = -1.0 + i / 15.0;
    ids = See(Shot({PersonAt(x_m, 2.4), PersonAt(-x_m, 3.6)}, i));
    if (i > 0) continue;
    ASSERT_EQ(ids.size(), 2U);
    first = ids;
  }
  ASSERT_EQ(ids.size(), 2U);
  EXPECT_EQ(ids[0], first[1]);
  EXPECT_EQ(ids[1], first[0]);
}

// Somebody walks past close before somebody who stands still. Tracks go on in any candidate; what
// is new must show a head and a trunk.
TEST_F(Identity, IsKeptCloseBehindSomebodyWhoPasses) {
  constexpr float kHeadAndTrunk_m2 = 0.2F;
  int hidden = 0;
  for (int i = 0; i <= 33; ++i) {
    const double x_m = -0.9 + 0.0375 * i;  // 1.1 m/s
    const CapsuleRender render = Shot({PersonAt(x_m, 2.4), PersonAt(0.0, 2.85)}, i);
    const Proposed proposed = Propose(render, state_);
    std::vector<Candidate> people = proposed.candidates;
    std::erase_if(people, [&](const Candidate& candidate) {
      return candidate.track < 0 && candidate.region.area_m2 < kHeadAndTrunk_m2;
    });
    const auto ids = Confirm(proposed, people, render.frame.time_s, state_, {}, 0.9);
    for (const int id : ids) EXPECT_LE(id, 2) << i;
    hidden += ids.size() < 2 ? 1 : 0;
    for (const Candidate& candidate : people) {
      const float deep_m = candidate.region.high_m.z() - candidate.region.low_m.z();
      EXPECT_LT(deep_m, 0.4F) << i << ": a candidate has parts of both";
    }
  }
  EXPECT_LE(hidden, 6);  // frames in which too little shows
}

TEST_F(Identity, SurvivesASecondOutOfView) {
  EXPECT_EQ(See(Shot({PersonAt(0.2, 2.5)}, 0)), std::vector<int>{1});
  for (int i = 1; i < 30; ++i) See(Shot({}, i));
  EXPECT_EQ(See(Shot({PersonAt(0.3, 2.5)}, 30)), std::vector<int>{1});
}

TEST_F(Identity, SurvivesAnOcclusionByAnotherPerson) {
  // Half visible for a few frames, then 1.2 s and 1.7 m behind a nearer person, then at the other
  // side.
  const auto far_x_m = [](int i) { return 1.35 - 1.4 * i / 30.0; };
  int far_id = 0;
  for (int i = 0; i <= 46; ++i) {
    std::vector<CapsulePose> people = {PersonAt(0, 1.8)};
    if (i <= 6 || i >= 43) people.push_back(PersonAt(far_x_m(i), 3.6));
    const std::vector<int> ids = See(Shot(people, i));
    ASSERT_EQ(ids.size(), people.size()) << i;
    if (i == 6) far_id = ids[0];
  }
  EXPECT_EQ(tracks().size(), 2U);
  EXPECT_EQ(See(Shot({PersonAt(0, 1.8), PersonAt(far_x_m(47), 3.6)}, 47))[1], far_id);
}

// Half of a walker is occluded at a time; the keypoints are on the whole body.
class HalfHidden : public testing::Test {
 protected:
  // Velocity after ten frames of walking at 1.5 m/s, with a visible share of `shown` in each.
  template <class Shown>
  Eigen::Vector3f VelocityAfter(const Shown& shown, bool with_keypoints) {
    PeopleState state;
    for (int f = 0; f < 10; ++f) {
      const float x_m = -0.4F + 0.05F * static_cast<float>(f);
      const CapsuleRender render = Shot({PersonAt(static_cast<double>(x_m), 2.5)}, f);
      const Proposed proposed = Propose(render, state);
      EXPECT_EQ(proposed.candidates.size(), 1U);
      Candidate person = proposed.candidates.at(0);
      const PointGrid& grid = proposed.scene.grid;
      std::vector<int> seen;
      for (const int cell : person.region.cells)
        if (grid.at(cell).x() > x_m + shown(f)) seen.push_back(cell);
      person.region = depth::MakeRegion(grid, std::move(seen));
      Keypoints keypoints_m;
      if (with_keypoints) {
        for (const float height_m : {-0.8F, -0.6F, -0.4F, -0.2F, 0.0F, 0.3F, 0.6F})
          keypoints_m.emplace_back(Eigen::Vector3f(x_m, height_m, 2.5F));
        const auto frame = static_cast<size_t>(f);
        if (f % 3 == 0) *keypoints_m[(frame + 1) % 7] += Eigen::Vector3f(0.4F, 0, 0.4F);
        keypoints_m[frame % 7].reset();
      }
      Confirm(proposed, {person}, render.frame.time_s, state, {keypoints_m});
    }
    return state.tracks.tracks.at(0).velocity_m_s;
  }
};

TEST_F(HalfHidden, VelocityIsThatOfTheKeypointsOnTheBody) {
  const auto uncovered = [](int f) { return 0.2F - 0.06F * static_cast<float>(f); };
  EXPECT_NEAR(VelocityAfter(uncovered, true).x(), 1.5F, 0.05F);
  EXPECT_LT(VelocityAfter(uncovered, false).x(), 1.2F);  // the visible centroid lags
}

TEST_F(Identity, VelocityOfAnOccludedPersonIsNotThatOfTheVisibleCentroid) {
  // A person comes out to the left from behind a nearer one who stands still.
  int seen = 0;
  for (int i = 0; i < 12; ++i) {
    See(Shot({PersonAt(0, 1.8), PersonAt(0.45 + 0.02 * i, 3.4)}, i));
    for (const Track& track : tracks()) {
      if (track.mean_m.z() < 2.6F || track.mean_m.x() < 0.4F) continue;
      EXPECT_EQ(track.velocity_m_s.norm(), 0.0F) << i;
      ++seen;
    }
  }
  EXPECT_GT(seen, 6);
}

TEST_F(Identity, ATrackThatIsPartOfAnotherIsDeleted) {
  // If kept, the part would claim its cells again in the next frame.
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)}, 0);
  const std::vector<int> ids = See(render);
  ASSERT_EQ(ids.size(), 2U);
  const CapsuleRender second = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)}, 1);
  const Proposed proposed = Propose(second, state_);
  ASSERT_EQ(proposed.candidates.size(), 2U);
  const Candidate whole =
      MergeCandidates(proposed.scene, second.frame, proposed.candidates[1], proposed.candidates[0]);
  const int goes_on_as = tracks()[static_cast<size_t>(proposed.candidates[1].track)].id;
  EXPECT_EQ(Confirm(proposed, {whole}, second.frame.time_s, state_), std::vector<int>{goes_on_as});
  EXPECT_EQ(tracks().size(), 1U);
}

TEST_F(Identity, TheLargerOfTwoSegmentsKeepsTheTrack) {
  ASSERT_EQ(See(Shot({PersonAt(0, 2.5)}, 0)), std::vector<int>{1});
  const CapsuleRender render = Shot({PersonAt(0, 2.5)}, 1);
  const Proposed proposed = Propose(render, state_);
  const PointGrid& grid = proposed.scene.grid;
  ASSERT_EQ(proposed.candidates.size(), 1U);
  Candidate piece = proposed.candidates[0], rest = piece;
  ASSERT_GE(piece.track, 0);
  const std::vector<int> cells = piece.region.cells;
  const auto cut = cells.begin() + static_cast<std::ptrdiff_t>(cells.size() / 5);
  piece.region = depth::MakeRegion(grid, {cells.begin(), cut});
  rest.region = depth::MakeRegion(grid, {cut, cells.end()});
  rest.track = -1;  // classified as a new person
  EXPECT_EQ(Confirm(proposed, {piece, rest}, render.frame.time_s, state_),
            (std::vector<int>{2, 1}));
}

TEST_F(Identity, NewRoomResetsTheScene) {
  EXPECT_EQ(See(Shot({PersonAt(0, 2.5)}, 0)), std::vector<int>{1});
  CapsuleScene other;
  other.people = {PersonAt(0.1, 2.5)};
  other.planes = {{{0, 1, 0}, 1.0}, {{0, 0, -1}, 3.4}};  // the wall is a metre nearer
  CapsuleRender render = tests::Render(other, KinectV1Camera(320, 240));
  render.frame.time_s = 1 / 30.0;
  EXPECT_EQ(See(render), std::vector<int>{2});
}

// A few cells in the middle of the image, placed `x_m` to the side.
Candidate SomebodyFarOff(const PointGrid& grid, float x_m) {
  Candidate person;
  person.region = depth::MakeRegion(grid, {grid.cell(40, 40), grid.cell(41, 40)});
  person.region.mean_m.x() = x_m;
  return person;
}

Proposed EmptyScene() {
  Proposed empty;
  empty.scene.grid = GridOf(Shot({}));
  return empty;
}

TEST(AssociateTracks, NeverReusesTheIdOfALostTrack) {
  const Proposed empty = EmptyScene();
  PeopleState state;
  state.tracks.next_id = 255;  // the last; then from 1 again
  for (const int id : {255, 1, 3}) {
    Track track;
    track.id = id;
    track.mean_m = {50, 0, 3};
    state.tracks.tracks.push_back(track);
  }
  const Candidate a = SomebodyFarOff(empty.scene.grid, -20),
                  b = SomebodyFarOff(empty.scene.grid, 20);
  EXPECT_EQ(Confirm(empty, {a, b}, 0.1, state), (std::vector<int>{2, 4}));
}

// No track expires while timestamps stand still, as from an application that gives none.
TEST(AssociateTracks, AnyNumberOfVisitorsHaveDifferentIdsThatFitAByte) {
  const Proposed empty = EmptyScene();
  PeopleState state;
  for (int i = 0; i < 300; ++i) {
    const Candidate visitor = SomebodyFarOff(empty.scene.grid, 20.0F * static_cast<float>(i));
    const int id = Confirm(empty, {visitor}, 0.0, state).at(0);
    EXPECT_TRUE(id >= 1 && id <= 255) << id;
    const auto has_it = [&](const Track& track) { return track.id == id; };
    EXPECT_EQ(std::count_if(state.tracks.tracks.begin(), state.tracks.tracks.end(), has_it), 1)
        << i;
  }
}

// Two tracks, of ids 1 and 2, at one place.
PeopleState TwoAtOnePlace(const Candidate& there) {
  PeopleState state;
  for (const int id : {1, 2}) {
    Track track;
    track.id = id;
    track.mean_m = there.region.mean_m;
    state.tracks.tracks.push_back(track);
  }
  return state;
}

TEST(AssociateTracks, AContinuedTrackIsNotReplacedByALostOneAtTheSamePlace) {
  const Proposed empty = EmptyScene();
  Candidate person = SomebodyFarOff(empty.scene.grid, 0.0F);
  for (const int track : {0, 1}) {
    PeopleState state = TwoAtOnePlace(person);
    person.track = track;
    EXPECT_EQ(Confirm(empty, {person}, 0.1, state), std::vector<int>{track + 1});
  }
}

// Two continuing people, one of whom holds most of the cells that the other one held.
TEST(AssociateTracks, AContinuedTrackTakesNoOtherTracksId) {
  const Proposed empty = EmptyScene();
  const PointGrid& grid = empty.scene.grid;
  std::vector<int> left, right;
  for (int x = 40; x < 60; ++x) (x < 42 ? left : right).push_back(grid.cell(x, 40));
  for (const int heirs_track : {0, 1}) {
    Candidate heir, other;
    heir.region = depth::MakeRegion(grid, right);
    other.region = depth::MakeRegion(grid, left);
    heir.track = heirs_track;
    other.track = 1 - heirs_track;
    PeopleState state = TwoAtOnePlace(other);
    Track& of_other = state.tracks.tracks[static_cast<size_t>(other.track)];
    for (int x = 40; x < 60; ++x) {
      of_other.cells.push_back(grid.cell(x, 40));
      of_other.z_m.push_back(grid.z(of_other.cells.back()));
    }
    EXPECT_EQ(Confirm(empty, {other, heir}, 0.1, state),
              (std::vector<int>{other.track + 1, heirs_track + 1}));
  }
}

TEST_F(Identity, IsLostBehindThePersonAtWhoseSilhouetteItWasLastSeen) {
  See(Shot({PersonAt(0, 1.8), PersonAt(0.5, 3.4), PersonAt(-1.2, 3.0)}, 0));
  ASSERT_EQ(tracks().size(), 3U);
  for (const Track& track : tracks()) EXPECT_FALSE(track.lost_behind) << "in view";
  See(Shot({PersonAt(0, 1.8)}, 1));
  ASSERT_EQ(tracks().size(), 3U);
  for (const Track& track : tracks()) EXPECT_EQ(track.lost_behind, track.mean_m.z() > 3.1F);
}

// A person seen at 10 s, who moved and lay there at 8 s, and is not visible in a frame at `time_s`.
Track UnseenAt(double time_s) {
  const Proposed empty = EmptyScene();
  PeopleState state;
  Track track;
  track.id = 1;
  track.age = 30;
  track.score = 0.9;
  track.last_seen_s = 10.0;
  track.moved_s = track.lay_s = 8.0;
  state.tracks.tracks.push_back(track);
  Confirm(empty, {}, time_s, state);
  return state.tracks.tracks.at(0);
}

// Otherwise a static track would count as moving until the time of its last movement comes again.
TEST(AssociateTracks, BackwardsTimeDoesNotMakeTracksMoveAfterTheirLastSighting) {
  const Track track = UnseenAt(-500.0);
  EXPECT_EQ(track.last_seen_s, -500.0);
  EXPECT_EQ(track.moved_s, -502.0);
  EXPECT_EQ(track.lay_s, -502.0);
}

TEST(AssociateTracks, LostTracksLoseTheirEvidenceWhenTheClockGoesBackByMoreThanJitter) {
  EXPECT_EQ(UnseenAt(10.03).age, 30);
  EXPECT_EQ(UnseenAt(9.997).age, 30);
  EXPECT_EQ(UnseenAt(9.99).age, 0);
}

TEST(AssociateTracks, TracksInViewAreConfirmedWhileTimeStandsStill) {
  std::vector<Track> tracks(2);
  tracks[0].id = 4;
  tracks[1].id = 7;  // seen at the same timestamp, but in the frame before
  const auto summaries = SummarizeTracks(tracks, {4});
  EXPECT_EQ(summaries[0].status, TrackStatus::kConfirmed);
  EXPECT_EQ(summaries[1].status, TrackStatus::kLost);
}

// Two tracks are lost, and two people return; the one between the lost places is already accepted:
// the id that this person gets.
int IdOfTheFirst(bool other_comes_too) {
  PeopleState state;
  for (int f = 0; f < 3; ++f) Confirm(Propose(Shot({}, f), state), {}, f / 30.0, state);
  for (const float x_m : {0.0F, -1.2F}) {
    Track track;
    track.id = state.tracks.next_id++;
    track.mean_m = {x_m, 0, 3};
    track.score = 0.9;
    track.last_seen_s = 3 / 30.0 - 1.0;
    state.tracks.tracks.push_back(track);
  }
  std::vector<CapsulePose> people = {PersonAt(-0.5, 3.1)};
  if (other_comes_too) people.push_back(PersonAt(0.25, 3.1));
  for (CapsulePose& pose : people) pose.left_lift_rad = pose.right_lift_rad = 0.05;
  const CapsuleRender render = Shot(people, 3);
  const Proposed proposed = Propose(render, state);
  EXPECT_EQ(proposed.candidates.size(), people.size());
  const auto first = std::min_element(proposed.candidates.begin(), proposed.candidates.end(),
                                      [](const Candidate& a, const Candidate& b) {
                                        return a.region.mean_m.x() < b.region.mean_m.x();
                                      });
  return Confirm(proposed, {*first}, render.frame.time_s, state).at(0);
}

TEST(AssociateTracks, UnconfirmedCandidatesCompeteForLostTracks) {
  EXPECT_EQ(IdOfTheFirst(false), 1);  // half a metre away, not seven tenths
  EXPECT_EQ(IdOfTheFirst(true), 2);   // the other one stands where the first was lost
}

}  // namespace
}  // namespace ossa::people
