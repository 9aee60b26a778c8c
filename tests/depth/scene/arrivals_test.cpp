// What came into the room, and what shows of it around somebody nearer.
#include <gtest/gtest.h>

#include <cmath>

#include "depth/scene/background.h"
#include "depth/scene/pieces.h"
#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

// Cells of the frame that are a person's.
std::vector<int> CellsOfPerson(const CapsuleRender& render, const PointGrid& grid) {
  std::vector<int> cells;
  for (int i = 0; i < grid.cells(); ++i) {
    const int u = i % grid.width * grid.step, v = i / grid.width * grid.step;
    if (grid.valid(i) && render.person.at(u, v) > 0) cells.push_back(i);
  }
  return cells;
}

double ShareOf(const std::vector<int>& cells, const std::vector<uint8_t>& marked) {
  double count = 0;
  for (const int cell : cells) count += marked[static_cast<size_t>(cell)] != 0 ? 1 : 0;
  return count / static_cast<double>(cells.size());
}

TEST(ArrivedSince, KnowsWhoCameFromWhatAlwaysStoodThere) {
  const std::vector<tests::Box> stool = {{{0.6, -1.0, 2.45}, {0.95, -0.4, 2.8}}};
  const PointGrid before = GridOf(Shot({}, 0, stool));
  BackgroundState state;
  LearnBackground(before, std::vector<uint8_t>(static_cast<size_t>(before.cells()), 0), state);
  const CapsuleRender render = Shot({PersonAt(-0.2, 2.5)}, 1, stool);
  const PointGrid now = GridOf(render);
  const auto arrived = ArrivedSince(now, state);
  // Feet stand on the floor that was seen there, at its own depth.
  EXPECT_GT(ShareOf(CellsOfPerson(render, now), arrived), 0.85);
  const PointGrid empty = GridOf(Shot({}));
  std::vector<int> of_stool;
  for (int i = 0; i < now.cells(); ++i) {
    if (before.z(i) < empty.z(i) - 0.1F && now.z(i) > before.z(i) - 0.05F) of_stool.push_back(i);
  }
  ASSERT_GT(of_stool.size(), 100U);
  EXPECT_EQ(ShareOf(of_stool, arrived), 0.0);  // without noise
}

TEST(ArrivedSince, SeesSomebodyBeforeWhatIsTooFarToMatter) {
  CapsuleScene scene;
  scene.planes = {{{0, 1, 0}, 1.0}, {{0, 0, -1}, 7.5}};  // the wall is beyond the 6 m looked at
  const PointGrid before = GridOf(tests::Render(scene, KinectV1Camera(320, 240)));
  BackgroundState state;
  LearnBackground(before, std::vector<uint8_t>(static_cast<size_t>(before.cells()), 0), state);
  scene.people = {PersonAt(0, 4.0)};
  const CapsuleRender render = tests::Render(scene, KinectV1Camera(320, 240));
  const PointGrid now = GridOf(render);
  const auto arrived = ArrivedSince(now, state);
  EXPECT_GT(ShareOf(CellsOfPerson(render, now), arrived), 0.85);
}

// Cells in which two pictures differ in depth, as connected pieces.
std::vector<Region> Changed(const PointGrid& before, const PointGrid& now) {
  std::vector<uint8_t> ignore(static_cast<size_t>(now.cells()), 0);
  for (int i = 0; i < now.cells(); ++i)
    ignore[static_cast<size_t>(i)] = std::abs(now.z(i) - before.z(i)) < 0.1F;
  return ConnectedRegions(now, ignore, 0.02F);
}

// What shows of something tall above a board and below it.
class Behind : public testing::Test {
 protected:
  void SetUp() override {
    const tests::Box board{{-0.5, -0.1, 2.0}, {0.5, 0.1, 2.05}};
    const tests::Box tall{{-0.15, -0.5, 3.2}, {0.15, 0.6, 3.4}};
    grid_ = GridOf(Shot({}, 0, {board, tall}));
    pieces_ = Changed(GridOf(Shot({}, 0, {board})), grid_);
    all_.assign(static_cast<size_t>(grid_.cells()), 1);
    nobody_.assign(all_.size(), -1);
  }
  PointGrid grid_;
  std::vector<Region> pieces_;
  std::vector<uint8_t> all_;
  std::vector<int> nobody_;
};

TEST_F(Behind, PiecesAtBothSidesOfSomethingNearerAreOne) {
  ASSERT_EQ(pieces_.size(), 2U);
  EXPECT_EQ(JoinBehind(grid_, pieces_, all_, nobody_, 0).size(), 1U);
}

TEST_F(Behind, WhatDidNotComeOrIsSomebodysStaysApart) {
  const std::vector<uint8_t> none(all_.size(), 0);
  EXPECT_EQ(JoinBehind(grid_, pieces_, none, nobody_, 0).size(), pieces_.size());
  for (const int cell : pieces_[0].cells) nobody_[static_cast<size_t>(cell)] = 0;
  EXPECT_GT(JoinBehind(grid_, pieces_, all_, nobody_, 1).size(), 1U);
}

// What shows of something broad at both sides of a post: the left piece is a user's of whom more
// was seen before, the right one comes out a stride from where the user is expected.
std::vector<Region> BroadBehind(const std::vector<tests::Box>& post) {
  const tests::Box broad{{-0.35, -0.5, 3.2}, {0.35, 0.2, 3.4}};
  std::vector<tests::Box> both = post;
  both.push_back(broad);
  const PointGrid grid = GridOf(Shot({}, 0, both));
  std::vector<Region> pieces;
  for (const bool left : {true, false}) {
    std::vector<int> cells;
    for (int i = 0; i < grid.cells(); ++i) {
      const Eigen::Vector3f& p = grid.at(i);
      if (p.z() > 3.1F && p.z() < 3.45F && p.y() > -0.52F &&
          (left ? p.x() > 0.17F : p.x() < -0.17F))
        cells.push_back(i);
    }
    pieces.push_back(MakeRegion(grid, std::move(cells)));
  }
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  for (const int cell : pieces[0].cells) owner[static_cast<size_t>(cell)] = 0;
  UserTrack user;
  user.mean_m = pieces[0].mean_m;
  return JoinByHistory(grid, std::move(pieces), owner, {user}, 0.0);
}

TEST(JoinByHistory, TakesWhatComesOutAtTheOtherSideOfSomebodyNearer) {
  const tests::Box post{{-0.1, -0.9, 2.0}, {0.1, 0.9, 2.05}};
  EXPECT_EQ(BroadBehind({post}).size(), 1U);
}

TEST(JoinByHistory, LeavesWhatStandsBesideWithNothingNearerBetween) {
  EXPECT_EQ(BroadBehind({}).size(), 2U);
}

TEST(PointGrid, HeadAndFeetAreAtOnePlaceOverTheFloorOfASensorThatLooksDown) {
  const float tilt_rad = 0.35F;
  PointGrid grid;
  grid.up = {0, std::cos(tilt_rad), -std::sin(tilt_rad)};
  const Eigen::Vector3f feet_m(0.5F, -1.0F, 3.0F), head_m = feet_m + 1.7F * grid.up;
  EXPECT_LT((grid.OnFloor(head_m) - grid.OnFloor(feet_m)).norm(), 1e-5F);
  const Eigen::Vector3f beside_m = feet_m + Eigen::Vector3f(0.3F, 0, 0);
  EXPECT_NEAR((grid.OnFloor(beside_m) - grid.OnFloor(feet_m)).x(), 0.3F, 1e-5F);
}

TEST(ArrivedArea, RimsDoNotCount) {
  const PointGrid grid = GridOf(Shot({}));
  std::vector<uint8_t> arrived(static_cast<size_t>(grid.cells()), 0);
  std::vector<int> cells;
  for (int y = 40; y < 60; ++y) {
    for (int x = 80; x < 82; ++x)
      cells.push_back(grid.cell(x, y)), arrived[static_cast<size_t>(cells.back())] = 1;
  }
  EXPECT_EQ(ArrivedArea_m2(grid, cells, arrived), 0.0F);
  for (int y = 40; y < 60; ++y)
    cells.push_back(grid.cell(82, y)), arrived[static_cast<size_t>(cells.back())] = 1;
  EXPECT_GT(ArrivedArea_m2(grid, cells, arrived), 0.0F);
}

TEST_F(Behind, LegsBelowATableBecomeTheirsWhoStandsAtIt) {
  ASSERT_EQ(pieces_.size(), 2U);
  const size_t body = pieces_[0].mean_m.y() > pieces_[1].mean_m.y() ? 0 : 1;
  for (const int cell : pieces_[body].cells) nobody_[static_cast<size_t>(cell)] = 0;
  EXPECT_EQ(JoinBelow(grid_, pieces_, 1, nobody_).size(), 1U);
  for (const int cell : pieces_[1 - body].cells) EXPECT_EQ(nobody_[static_cast<size_t>(cell)], 0);
}

TEST_F(Behind, ATablesOwnLegsAreTooThin) {
  const Region& legs = pieces_[pieces_[0].mean_m.y() < pieces_[1].mean_m.y() ? 0 : 1];
  const int middle = legs.cells[legs.cells.size() / 2] % grid_.width;
  std::vector<int> thin;
  for (const int cell : legs.cells) {
    if (std::abs(cell % grid_.width - middle) < 2) thin.push_back(cell);  // 6 cm
  }
  auto regions = pieces_;
  regions[&legs == &pieces_[0] ? 0 : 1] = MakeRegion(grid_, thin);
  EXPECT_EQ(JoinBelow(grid_, regions, 0, nobody_).size(), 2U);
}

// A box like a person that stood there before somebody who came passed it and went out of view.
TEST(WhoCame, DoesNotGoOnAsFurnitureThatStoodThereBefore) {
  const tests::Box box{{-0.17, -0.95, 3.0}, {0.17, 0.5, 3.2}};
  SceneState state, next;
  const Scene before = FindCandidates(Shot({}, 0, {box}).frame, state, next);
  ASSERT_EQ(before.candidates.size(), 1U);
  state = std::move(next);
  ConfirmUsers(before, {}, 0.0, state);
  UserTrack user;
  user.id = 1;
  user.cells = before.candidates[0].region.cells;
  for (const int cell : user.cells) user.z_m.push_back(before.grid.z(cell));
  // Last seen together with the box, of which nothing came.
  for (const bool came : {false, true}) {
    user.came = came;
    state.users = {user};
    const Scene now = FindCandidates(Shot({}, 1, {box}).frame, state, next);
    ASSERT_EQ(now.candidates.size(), 1U);
    EXPECT_EQ(now.candidates[0].track, came ? -1 : 0);
  }
}

TEST(WhoCame, IsRememberedHoweverMuchFurnitureTheyHoldLater) {
  SceneState state, next;
  for (int f = 0; f < 2; ++f) {
    const Scene scene = FindCandidates(Shot({PersonAt(0, 2.5)}, f).frame, state, next);
    ASSERT_EQ(scene.candidates.size(), 1U);
    Candidate person = scene.candidates[0];
    person.arrived_share = f == 0 ? 0.9 : 0.2;
    state = std::move(next);
    ConfirmUsers(scene, {&person}, f / 30.0, state);
    ASSERT_EQ(state.users.size(), 1U);
    EXPECT_TRUE(state.users[0].came);
  }
}

// Somebody walks up to a box that stood there before, and stays at it: the share of what is held
// for them that is theirs.
double ShareOfPersonAtABox(bool came) {
  const tests::Box box{{-0.3, -0.5, 2.45}, {-0.05, 0.3, 2.7}};
  SceneState state, next;
  double share = 0;
  for (int f = 0; f < 30; ++f) {
    CapsulePose pose = PersonAt(f < 13 ? 0.9 - 0.06 * f : 0.16, 2.6);
    pose.left_lift_rad = pose.right_lift_rad = 0.1;
    const CapsuleRender render =
        Shot(f < 4 ? std::vector<CapsulePose>{} : std::vector{pose}, f, {box});
    const Scene scene = FindCandidates(render.frame, state, next);
    state = std::move(next);
    std::vector<const Candidate*> people;
    for (const Candidate& candidate : scene.candidates) {
      double theirs = 0;
      for (const int32_t pixel : candidate.pixels)
        theirs += render.person.data[static_cast<size_t>(pixel)] > 0 ? 1 : 0;
      theirs /= static_cast<double>(candidate.pixels.size());
      if (candidate.track < 0 && theirs < 0.5) continue;
      people.push_back(&candidate);
      share = theirs;
    }
    ConfirmUsers(scene, people, render.frame.time_s, state);
    for (UserTrack& user : state.users) user.came = came;
  }
  return share;
}

TEST(WhoCame, DoesNotCreepIntoTheFurnitureTheyTouch) {
  EXPECT_GT(ShareOfPersonAtABox(true), 0.85);
  EXPECT_LT(ShareOfPersonAtABox(false), 0.8);  // for all that is known of them it may be theirs
}

// What comes into view beside somebody seen.
Candidate NewBeside(float apart_m) {
  SceneState state, next;
  const auto see = [&](const CapsuleRender& render, bool people) {
    const Scene scene = FindCandidates(render.frame, state, next);
    state = next;
    std::vector<const Candidate*> users;
    for (const Candidate& candidate : scene.candidates) users.push_back(&candidate);
    if (!people) users.clear();
    ConfirmUsers(scene, users, render.frame.time_s, state);
  };
  CapsulePose person = PersonAt(0, 2.5);
  person.left_lift_rad = person.right_lift_rad = 3.0;  // out of the way
  see(Shot({}, 0), false);
  see(Shot({person}, 1), true);
  const double x_m = static_cast<double>(apart_m);
  const tests::Box thing{{x_m - 0.08, -0.8, 2.5}, {x_m + 0.08, 0.2, 2.6}};
  const CapsuleRender render = Shot({person}, 2, {thing});
  for (const Candidate& candidate : FindCandidates(render.frame, state, next).candidates) {
    if (candidate.track < 0) return candidate;
  }
  ADD_FAILURE() << "nothing new";
  return {};
}

TEST(FindCandidates, WhatComesIntoViewCloseToSomebodySeenMayBeTheRestOfThem) {
  EXPECT_EQ(NewBeside(0.4F).arrived_share, 0.0);
  EXPECT_GT(NewBeside(0.9F).arrived_share, 0.9);
  // 8 cm of the thing and some 20 cm of the person lie between the middles and the sides.
  EXPECT_FALSE(NewBeside(0.9F).alone);
  EXPECT_TRUE(NewBeside(1.1F).alone);
}

// Pieces of what came where nothing was, with the wall in view between them, joined: how many
// remain.
size_t JoinedOf(const tests::Box& a, const tests::Box& b) {
  const PointGrid grid = GridOf(Shot({}, 0, {a, b}));
  auto regions = Changed(GridOf(Shot({})), grid);
  EXPECT_EQ(regions.size(), 2U);
  const auto cells = static_cast<size_t>(grid.cells());
  return JoinBehind(grid, std::move(regions), std::vector<uint8_t>(cells, 1),
                    std::vector<int>(cells, -1), 0)
      .size();
}

TEST(JoinBehind, NobodyComesAboveSomebodyElseAtOnePlace) {
  const tests::Box lower{{-0.1, -0.9, 3.0}, {0.1, -0.3, 3.2}};
  EXPECT_EQ(JoinedOf(lower, {{-0.2, 0.1, 3.0}, {0.0, 0.5, 3.2}}), 1U);
  EXPECT_EQ(JoinedOf(lower, {{-0.2, 0.1, 3.6}, {0.0, 0.5, 3.8}}), 2U);     // behind,
  EXPECT_EQ(JoinedOf(lower, {{0.45, 0.1, 3.0}, {0.65, 0.5, 3.2}}), 2U);    // to the side,
  EXPECT_EQ(JoinedOf(lower, {{0.15, -0.7, 3.0}, {0.35, -0.1, 3.2}}), 2U);  // half beside
}

TEST(JoinBehind, SomebodyInStrideShowsAtBothSidesOfSomebodyNear) {
  const tests::Box post{{-0.17, -0.9, 2.0}, {0.17, 0.9, 2.05}};
  const tests::Box strider{{-0.38, -0.8, 3.2}, {0.38, 0.3, 3.4}};
  const PointGrid grid = GridOf(Shot({}, 0, {post, strider}));
  auto regions = Changed(GridOf(Shot({}, 0, {post})), grid);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_GT(std::abs(regions[0].mean_m.x() - regions[1].mean_m.x()), 0.6F);
  const auto cells = static_cast<size_t>(grid.cells());
  EXPECT_EQ(JoinBehind(grid, std::move(regions), std::vector<uint8_t>(cells, 1),
                       std::vector<int>(cells, -1), 0)
                .size(),
            1U);
}

TEST(OneAbove, IsMeantOverTheFloorAlsoOfASensorThatLooksDown) {
  const float tilt_rad = 0.45F;
  PointGrid grid;
  grid.up = {0, std::cos(tilt_rad), -std::sin(tilt_rad)};
  const auto piece = [&](float height_m, float beside_m) {
    Region region;
    region.mean_m = Eigen::Vector3f(beside_m, -1, 3) + height_m * grid.up;
    region.low_m = region.mean_m - Eigen::Vector3f(0.2F, 0.25F, 0.1F);
    region.high_m = region.mean_m + Eigen::Vector3f(0.2F, 0.25F, 0.1F);
    return region;
  };
  const Region trousers = piece(0.5F, 0), shirt = piece(1.2F, 0);
  EXPECT_GT(trousers.mean_m.z() - shirt.mean_m.z(), 0.3F);  // as the sensor sees it
  EXPECT_TRUE(OneAbove(grid, trousers, shirt));
  EXPECT_TRUE(OneAbove(grid, shirt, trousers));
  EXPECT_FALSE(OneAbove(grid, trousers, piece(1.2F, 0.5F)));
  EXPECT_FALSE(OneAbove(grid, trousers, piece(0.6F, 0.2F)));
}

TEST(JoinBehind, ThingsSideBySideWithTheWallBetweenThemStayApart) {
  const CapsuleRender render =
      Shot({}, 0, {{{-0.3, -0.6, 3.0}, {-0.1, 0.2, 3.2}}, {{0.1, -0.6, 3.0}, {0.3, 0.2, 3.2}}});
  const PointGrid grid = GridOf(render);
  auto regions = Changed(GridOf(Shot({})), grid);
  ASSERT_EQ(regions.size(), 2U);
  const auto cells = static_cast<size_t>(grid.cells());
  EXPECT_EQ(JoinBehind(grid, std::move(regions), std::vector<uint8_t>(cells, 1),
                       std::vector<int>(cells, -1), 0)
                .size(),
            2U);
}

}  // namespace
}  // namespace ossa::depth
