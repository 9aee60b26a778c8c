// Who may be people in a frame, from shape alone: floor, flat pieces, heads, cuts, identities.
#include "depth/scene/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "depth/scene/heads.h"
#include "depth/scene/planes.h"
#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

Scene Candidates(const CapsuleRender& render) {
  SceneState next;
  return FindCandidates(render.frame, {}, next);
}

// Share of a person's pixels that a candidate has, and of the candidate that is the person's.
std::pair<double, double> Covered(const CapsuleRender& render, const Candidate& candidate,
                                  int person) {
  double whole = 0, common = 0;
  for (const uint8_t p : render.person.data) whole += p == person ? 1 : 0;
  for (const int32_t pixel : candidate.pixels)
    common += render.person.data[static_cast<size_t>(pixel)] == person ? 1 : 0;
  return {common / whole, common / static_cast<double>(candidate.pixels.size())};
}

TEST(FindFloor, IsTheEmptyRoomsFloor) {
  FloorState state;
  const auto floor = FindFloor(GridOf(Shot({PersonAt(0, 2.5)})), state);
  ASSERT_TRUE(floor.has_value());
  // The lowest strip of the wall is within a Kinect's error of the floor and tilts it a little.
  EXPECT_NEAR(floor->coefficients[3], 1.0, 0.03);
  EXPECT_GT(floor->coefficients[1], std::cos(0.02));
}

TEST(FindFloor, IsNotInventedFromAWallAlone) {
  CapsuleScene scene;
  scene.planes = {{{0, 0, -1}, 2.0}};
  FloorState state;
  EXPECT_FALSE(FindFloor(GridOf(tests::Render(scene, KinectV1Camera(320, 240))), state));
}

TEST(FlatPieces, FindTheWallWithItsNormalAndArea) {
  CapsuleScene scene;
  scene.planes = {{{0, 0, -1}, 3.0}};
  const PointGrid grid = GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
  const auto pieces = FlatPieces(grid, std::vector<uint8_t>(static_cast<size_t>(grid.cells()), 0));
  ASSERT_FALSE(pieces.empty());
  EXPECT_LT(pieces[0].normal.z(), -0.999);
  // The image shows 320 / 287.5 x 240 / 287.5 of the distance: 8.36 m2 at 3 m. Cells towards the
  // corners are counted a little larger than they are: they lie slanted to their line of sight.
  EXPECT_NEAR(pieces[0].area_m2, 8.36, 0.08 * 8.36);
}

TEST(RoomSurfaces, TakesTheRoomAndLeavesThePerson) {
  const CapsuleRender render = Shot({PersonAt(0, 1.8)});
  const PointGrid grid = GridOf(render);
  FloorState state;
  const RoomShape shape = RoomSurfaces(grid, FindFloor(grid, state));
  int person = 0, taken = 0, room = 0, left = 0;
  for (int cell = 0; cell < grid.cells(); ++cell) {
    if (!grid.valid(cell)) continue;
    const bool mine =
        render.person.at(cell % grid.width * grid.step, cell / grid.width * grid.step) > 0;
    const bool gone = shape.room[static_cast<size_t>(cell)] != 0;
    (mine ? person : room) += 1;
    taken += mine && gone ? 1 : 0;
    left += !mine && !gone ? 1 : 0;
  }
  EXPECT_LT(taken, 0.05 * person);  // soles
  EXPECT_LT(left, 0.05 * room);     // edges, where nothing is flat
}

// Share of a box's pixels that are taken for the room.
double RoomShare(const CapsuleRender& with, const CapsuleRender& without) {
  const PointGrid grid = GridOf(with), before = GridOf(without);
  FloorState state;
  const RoomShape shape = RoomSurfaces(grid, FindFloor(grid, state));
  double box = 0, room = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i) || std::abs(grid.z(i) - before.z(i)) < 0.05F) continue;
    box += 1;
    room += shape.room[static_cast<size_t>(i)] != 0 ? 1 : 0;
  }
  return room / box;
}

TEST(RoomSurfaces, KnowTheFrontOfASofaThatLegsCutInTwo) {
  // 1.6 m wide and 0.42 m high, 30 cm behind the feet: each half has the area of a person's side.
  const std::vector<CapsulePose> people = {PersonAt(0, 2.4)};
  const std::vector<tests::Box> sofa = {{{-0.8, -1.0, 2.7}, {0.8, -0.58, 3.3}}};
  // Cells at edges see half the box and half what is behind.
  EXPECT_GT(RoomShare(Shot(people, 0, sofa), Shot(people)), 0.8);
}

TEST(RoomSurfaces, KnowATableSeenAlmostFromItsOwnHeight) {
  // 12 cm below the sensor its top is a few rows of cells, and depth noise moves them by
  // centimetres: no plane fits. Their height it moves by some 3 mm.
  constexpr double kTop_m = -0.12;
  CapsuleScene scene;
  scene.people = {PersonAt(0.9, 3.2)};
  scene.planes = tests::EmptyRoom();
  scene.boxes = {{{-0.6, kTop_m - 0.04, 1.4}, {0.6, kTop_m, 2.8}}};
  scene.noise_m = 0.005;
  const PointGrid grid = GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
  FloorState state;
  const RoomShape shape = RoomSurfaces(grid, FindFloor(grid, state));
  double top = 0, room = 0;
  for (int i = 0; i < grid.cells(); ++i) {
    const Eigen::Vector3f p = grid.at(i);
    if (p.z() < 1.5F || p.z() > 2.7F || std::abs(p.x()) > 0.55F) continue;
    if (std::abs(p.y() - static_cast<float>(kTop_m)) > 0.01F) continue;
    top += 1;
    room += shape.room[static_cast<size_t>(i)] != 0 ? 1 : 0;
  }
  ASSERT_GT(top, 200);
  EXPECT_GT(room, 0.95 * top);
}

TEST(SplitBySeeds, EntersWhatStoodThereBeforeByARimOnly) {
  const std::vector<tests::Box> stool = {{{0.1, -1.0, 2.45}, {0.45, -0.4, 2.8}}};
  const CapsuleRender render = Shot({PersonAt(0, 2.5)}, 0, stool);
  const PointGrid grid = GridOf(render), empty = GridOf(Shot({}));
  std::vector<int> all;
  Seed person{{}, 0.5F, nullptr};
  std::vector<uint8_t> stood(static_cast<size_t>(grid.cells()), 0);
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i) || std::abs(grid.z(i) - empty.z(i)) < 0.1F) continue;
    all.push_back(i);
    const bool mine = render.person.at(i % grid.width * grid.step, i / grid.width * grid.step) > 0;
    if (mine) person.cells.push_back(i);
    stood[static_cast<size_t>(i)] = !mine;
  }
  const Region region = MakeRegion(grid, all);
  const double stool_cells = static_cast<double>(all.size() - person.cells.size());
  const auto grown = [&](const Seed& seed) {
    const Region piece = SplitBySeeds(grid, region, {seed}).at(0);
    return static_cast<double>(piece.cells.size() - seed.cells.size()) / stool_cells;
  };
  EXPECT_GT(grown(person), 0.8);  // half a metre over the surface is nearly all of it
  person.barred = &stood;
  EXPECT_LT(grown(person), 0.4);  // a rim of 6 cm of 35
}

TEST(FindHeads, IsWhereTheHeadIs) {
  const CapsuleRender render = Shot({PersonAt(0.2, 2.5)});
  const Scene scene = Candidates(render);
  ASSERT_EQ(scene.candidates.size(), 1U);
  const auto heads = FindHeads(scene.grid, scene.candidates[0].region);
  ASSERT_EQ(heads.size(), 1U);
  const Eigen::Vector3d head = render.joints[0][recon::Joint::kHead];
  // On the surface of a head of about 10 cm radius.
  EXPECT_LT((heads[0].position_m.cast<double>() - head).norm(), 0.16);
}

TEST(FindCandidates, APersonIsOnePieceWithoutTheRoom) {
  const CapsuleRender render = Shot({PersonAt(0, 2.5)});
  const Scene scene = Candidates(render);
  ASSERT_EQ(scene.candidates.size(), 1U);
  const auto [person, candidate] = Covered(render, scene.candidates[0], 1);
  EXPECT_GT(person, 0.9);  // the soles are within the floor's tolerance
  EXPECT_GT(candidate, 0.97);
}

TEST(FindCandidates, NobodyIsThereInAnEmptyRoom) {
  EXPECT_TRUE(Candidates(Shot({})).candidates.empty());
}

TEST(FindCandidates, ATableTopIsNotPartOfWhoStandsAtIt) {
  const tests::Box top{{-0.7, -0.30, 2.0}, {0.7, -0.25, 2.45}};
  const CapsuleRender render = Shot({PersonAt(0, 2.6)}, 0, {top});
  double best = 0;
  for (const Candidate& candidate : Candidates(render).candidates)
    best = std::max(best, Covered(render, candidate, 1).second);
  EXPECT_GT(best, 0.85);  // an edge of the top may stay
}

TEST(FindCandidates, TwoWhoTouchAreCutBetweenTheirHeads) {
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)});
  const Scene scene = Candidates(render);
  ASSERT_EQ(scene.candidates.size(), 2U);
  EXPECT_EQ(scene.candidates[0].origin, scene.candidates[1].origin);
  for (const Candidate& candidate : scene.candidates) {
    const double best =
        std::max(Covered(render, candidate, 1).second, Covered(render, candidate, 2).second);
    EXPECT_GT(best, 0.85);  // the touching hands may go either way
  }
}

TEST(JoinCandidates, GivesBackWhatWasCut) {
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)});
  const Scene scene = Candidates(render);
  ASSERT_EQ(scene.candidates.size(), 2U);
  const Candidate& a = scene.candidates[0];
  const Candidate& b = scene.candidates[1];
  const Candidate whole = JoinCandidates(scene, render.frame, a, b);
  EXPECT_EQ(whole.region.cells.size(), a.region.cells.size() + b.region.cells.size());
  // At the seam a pixel may have belonged to both or to neither.
  EXPECT_NEAR(static_cast<double>(whole.pixels.size()),
              static_cast<double>(a.pixels.size() + b.pixels.size()), 60.0);
}

TEST(Adjoining, AreHalvesOfAPersonAndNotPeopleApart) {
  const Scene scene = Candidates(Shot({PersonAt(-0.6, 2.5), PersonAt(0.6, 2.5)}));
  ASSERT_EQ(scene.candidates.size(), 2U);
  const Candidate& person = scene.candidates[0];
  std::vector<int> upper, lower;
  for (const int cell : person.region.cells)
    (scene.grid.at(cell).y() > 0 ? upper : lower).push_back(cell);
  Candidate above, below;
  above.region = MakeRegion(scene.grid, upper);
  below.region = MakeRegion(scene.grid, lower);
  EXPECT_TRUE(Adjoining(scene, above, below));
  EXPECT_FALSE(Adjoining(scene, person, scene.candidates[1]));
}

class Identity : public testing::Test {
 protected:
  // All candidates are people; ids from left to right of the sensor (falling x).
  std::vector<int> See(const CapsuleRender& render) {
    SceneState next;
    const Scene scene = FindCandidates(render.frame, state_, next);
    fresh_ = scene.fresh;
    std::vector<const Candidate*> people;
    for (const Candidate& candidate : scene.candidates) people.push_back(&candidate);
    std::sort(people.begin(), people.end(), [](const Candidate* a, const Candidate* b) {
      return a->region.mean_m.x() > b->region.mean_m.x();
    });
    state_ = std::move(next);
    return ConfirmUsers(scene, people, render.frame.time_s, state_);
  }
  SceneState state_;
  bool fresh_ = false;
};

TEST_F(Identity, StaysWhileAPersonWalks) {
  for (int i = 0; i < 20; ++i)
    EXPECT_EQ(See(Shot({PersonAt(-0.5 + 0.05 * i, 2.5)}, i)), std::vector<int>{1}) << i;
}

TEST_F(Identity, OfTwoWhoPassEachOtherStaysWithEach) {
  // Two metres a second, a metre apart: for a moment the farther one is hidden.
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

TEST_F(Identity, SurvivesASecondOutOfView) {
  EXPECT_EQ(See(Shot({PersonAt(0.2, 2.5)}, 0)), std::vector<int>{1});
  for (int i = 1; i < 30; ++i) See(Shot({}, i));
  EXPECT_EQ(See(Shot({PersonAt(0.3, 2.5)}, 30)), std::vector<int>{1});
}

TEST_F(Identity, SurvivesAWayBehindSomebodyElse) {
  // Half seen for a few frames, then 1.2 s and 1.7 m behind somebody near, then at the other side.
  const auto far_x_m = [](int i) { return 1.35 - 1.4 * i / 30.0; };
  int far_id = 0;
  for (int i = 0; i <= 46; ++i) {
    std::vector<CapsulePose> people = {PersonAt(0, 1.8)};
    if (i <= 6 || i >= 43) people.push_back(PersonAt(far_x_m(i), 3.6));
    const std::vector<int> ids = See(Shot(people, i));
    ASSERT_EQ(ids.size(), people.size()) << i;
    if (i == 6) far_id = ids[0];
  }
  EXPECT_EQ(state_.users.size(), 2U);
  EXPECT_EQ(See(Shot({PersonAt(0, 1.8), PersonAt(far_x_m(47), 3.6)}, 47))[1], far_id);
}

// Half of somebody who walks is hidden at a time; the candidates' marks are on the whole body.
class HalfHidden : public testing::Test {
 protected:
  // Velocity after ten frames of a walk of 1.5 m/s of which `shown` of 1 is seen in each.
  template <class Shown>
  Eigen::Vector3f VelocityAfter(const Shown& shown, bool marked) {
    SceneState state, next;
    for (int f = 0; f < 10; ++f) {
      const float x_m = -0.4F + 0.05F * static_cast<float>(f);
      const CapsuleRender render = Shot({PersonAt(static_cast<double>(x_m), 2.5)}, f);
      const Scene scene = FindCandidates(render.frame, state, next);
      EXPECT_EQ(scene.candidates.size(), 1U);
      Candidate person = scene.candidates.at(0);
      std::vector<int> seen;
      for (const int cell : person.region.cells)
        if (scene.grid.at(cell).x() > x_m + shown(f)) seen.push_back(cell);
      person.region = MakeRegion(scene.grid, std::move(seen));
      if (marked) {
        for (const float height_m : {-0.8F, -0.6F, -0.4F, -0.2F, 0.0F, 0.3F, 0.6F})
          person.marks_m.emplace_back(Eigen::Vector3f(x_m, height_m, 2.5F));
        const auto frame = static_cast<size_t>(f);
        if (f % 3 == 0) *person.marks_m[(frame + 1) % 7] += Eigen::Vector3f(0.4F, 0, 0.4F);
        person.marks_m[frame % 7].reset();
      }
      state = std::move(next);
      ConfirmUsers(scene, {&person}, render.frame.time_s, state);
    }
    return state.users.at(0).velocity_m_s;
  }
};

TEST_F(HalfHidden, WalksAsTheMarksOnTheBodyDo) {
  const auto uncovered = [](int f) { return 0.2F - 0.06F * static_cast<float>(f); };
  EXPECT_NEAR(VelocityAfter(uncovered, true).x(), 1.5F, 0.05F);
  EXPECT_LT(VelocityAfter(uncovered, false).x(), 1.2F);  // the middle of what is seen lags
}

TEST_F(Identity, BesideSomebodyNearerTheMiddleOfTheSurfaceSaysNothingOfTheVelocity) {
  // Somebody comes out to the left from behind somebody near who stands still.
  int seen = 0;
  for (int i = 0; i < 12; ++i) {
    See(Shot({PersonAt(0, 1.8), PersonAt(0.45 + 0.02 * i, 3.4)}, i));
    for (const UserTrack& user : state_.users) {
      if (user.mean_m.z() < 2.6F || user.mean_m.x() < 0.4F) continue;
      EXPECT_EQ(user.velocity_m_s.norm(), 0.0F) << i;
      ++seen;
    }
  }
  EXPECT_GT(seen, 6);
}

TEST_F(Identity, WhoTurnsOutToBePartOfAnotherIsForgotten) {
  // Remembered, the part would claim its cells again in the next frame.
  const CapsuleRender render = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)}, 0);
  const std::vector<int> ids = See(render);
  ASSERT_EQ(ids.size(), 2U);
  SceneState next;
  const CapsuleRender second = Shot({PersonAt(-0.3, 2.5), PersonAt(0.3, 2.5)}, 1);
  const Scene scene = FindCandidates(second.frame, state_, next);
  ASSERT_EQ(scene.candidates.size(), 2U);
  const Candidate whole =
      JoinCandidates(scene, second.frame, scene.candidates[1], scene.candidates[0]);
  const int goes_on_as = next.users[static_cast<size_t>(scene.candidates[1].track)].id;
  EXPECT_EQ(ConfirmUsers(scene, {&whole}, second.frame.time_s, next), std::vector<int>{goes_on_as});
  EXPECT_EQ(next.users.size(), 1U);
}

TEST_F(Identity, OfTwoPiecesOfSomebodyTheLargerGoesOn) {
  ASSERT_EQ(See(Shot({PersonAt(0, 2.5)}, 0)), std::vector<int>{1});
  SceneState next;
  const CapsuleRender render = Shot({PersonAt(0, 2.5)}, 1);
  const Scene scene = FindCandidates(render.frame, state_, next);
  ASSERT_EQ(scene.candidates.size(), 1U);
  Candidate piece = scene.candidates[0], rest = piece;
  ASSERT_GE(piece.track, 0);
  const std::vector<int> cells = piece.region.cells;
  const auto cut = cells.begin() + static_cast<std::ptrdiff_t>(cells.size() / 5);
  piece.region = MakeRegion(scene.grid, {cells.begin(), cut});
  rest.region = MakeRegion(scene.grid, {cut, cells.end()});
  rest.track = -1;  // the forest took it for somebody new
  EXPECT_EQ(ConfirmUsers(scene, {&piece, &rest}, render.frame.time_s, next),
            (std::vector<int>{2, 1}));
}

TEST_F(Identity, ASceneIsFreshAtFirstAndAfterAGap) {
  See(Shot({PersonAt(0, 2.5)}, 0));
  EXPECT_TRUE(fresh_);
  See(Shot({PersonAt(0, 2.5)}, 1));
  EXPECT_FALSE(fresh_);
  See(Shot({PersonAt(0, 2.5)}, 40));
  EXPECT_TRUE(fresh_);
}

TEST_F(Identity, AnotherRoomIsAnotherScene) {
  EXPECT_EQ(See(Shot({PersonAt(0, 2.5)}, 0)), std::vector<int>{1});
  CapsuleScene other;
  other.people = {PersonAt(0.1, 2.5)};
  other.planes = {{{0, 1, 0}, 1.0}, {{0, 0, -1}, 3.4}};  // the wall is a metre nearer
  CapsuleRender render = tests::Render(other, KinectV1Camera(320, 240));
  render.frame.time_s = 1 / 30.0;
  EXPECT_EQ(See(render), std::vector<int>{2});
  EXPECT_TRUE(fresh_);
}

}  // namespace
}  // namespace ossa::depth
