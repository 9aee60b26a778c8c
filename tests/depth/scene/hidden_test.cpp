// Somebody of whom something nearer hides a part: a seat before them, somebody who passes.
#include <gtest/gtest.h>

#include <algorithm>

#include "depth/scene/boards_internal.h"
#include "depth/scene/heads.h"
#include "depth/scene/outline_internal.h"
#include "depth/scene/pieces.h"
#include "depth/scene/scene.h"
#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

// The back of a seat, frontal, 2.2 m away; below it one looks through.
tests::Box SeatBack(double top_m) { return {{-0.31, -0.2, 2.2}, {0.31, top_m, 2.3}}; }

CapsulePose SomebodyAt(double z_m) {
  CapsulePose pose = PersonAt(0, z_m);
  pose.left_lift_rad = pose.right_lift_rad = 0.05;
  return pose;
}

RoomShape ShapeOf(const PointGrid& grid) {
  FloorState state;
  return RoomSurfaces(grid, FindFloor(grid, state));
}

// Cells nearer than the wall that are (or are not) a person's.
Region RegionOf(const CapsuleRender& render, const PointGrid& grid, bool person) {
  std::vector<int> cells;
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i) || grid.z(i) > 4.0F || grid.at(i).y() < -0.9F) continue;
    const int u = i % grid.width * grid.step, v = i / grid.width * grid.step;
    if ((render.person.at(u, v) > 0) == person) cells.push_back(i);
  }
  return MakeRegion(grid, std::move(cells));
}

TEST(BoardOf, IsTheBackOfASeatAndNobody) {
  const CapsuleRender render = Shot({SomebodyAt(2.7)}, 0, {SeatBack(0.2)});
  const PointGrid grid = GridOf(render);
  const RoomShape shape = ShapeOf(grid);
  const auto seat = BoardOf(RegionOf(render, grid, false), shape);
  ASSERT_TRUE(seat.has_value());
  EXPECT_NEAR(1 / seat->At(grid.width / 2, grid.height / 2), 2.2, 0.02);
  const Region person = RegionOf(render, grid, true);
  EXPECT_FALSE(BoardOf(person, shape).has_value());
  EXPECT_TRUE(StandsBehind(grid, person, *seat));
  const CapsuleRender before = Shot({SomebodyAt(2.0)}, 0, {SeatBack(0.2)});
  EXPECT_FALSE(StandsBehind(GridOf(before), RegionOf(before, GridOf(before), true), *seat));
}

TEST(FindCandidates, TheBackOfASeatIsNoPartOfWhoShowsAboveIt) {
  const CapsuleRender render = Shot({SomebodyAt(2.7)}, 0, {SeatBack(0.27)});
  SceneState next;
  const Scene scene = FindCandidates(render.frame, {}, next);
  const auto has = [&](bool board, bool high) {
    return std::find_if(scene.candidates.begin(), scene.candidates.end(),
                        [&](const Candidate& candidate) {
                          return candidate.board.has_value() == board &&
                                 (candidate.region.high_m.y() > 0.5F) == high;
                        });
  };
  const auto seat_at = has(true, false), person_at = has(false, true);
  ASSERT_NE(seat_at, scene.candidates.end());
  ASSERT_NE(person_at, scene.candidates.end());
  const Candidate &seat = *seat_at, &person = *person_at;
  EXPECT_LT(person.region.area_m2, 0.12F);  // as small as a limb that was cut off
  EXPECT_TRUE(HidesPartOf(scene, seat, person));
  EXPECT_FALSE(HidesPartOf(scene, person, seat));
  for (const int32_t pixel : person.pixels)
    EXPECT_EQ(render.person.data[static_cast<size_t>(pixel)], 1);
}

TEST(FindHeads, AlsoWhereSomethingNearerHidesTheShoulders) {
  for (const bool hidden : {true, false}) {
    const CapsuleRender render = Shot({SomebodyAt(2.7)}, 0, {SeatBack(0.32)});
    PointGrid grid = GridOf(render);
    const Region head = RegionOf(render, grid, true);
    const Region seat = RegionOf(render, grid, false);
    // Where nothing is nearer, what ends so soon is no head on shoulders.
    for (const int cell : seat.cells)
      if (!hidden) grid.point_m[static_cast<size_t>(cell)] *= 4.5F / 2.2F;
    EXPECT_EQ(FindHeads(grid, head).size(), hidden ? 1U : 0U);
  }
}

double HiddenShareOf(const CapsuleRender& render) {
  const PointGrid grid = GridOf(render);
  FloorState state;
  return HiddenShare(grid, FindFloor(grid, state), RegionOf(render, grid, true));
}

TEST(HiddenShare, IsOfTheOutlineBesideWhatIsNearer) {
  EXPECT_LT(HiddenShareOf(Shot({SomebodyAt(2.7)})), 0.03);
  EXPECT_LT(HiddenShareOf(Shot({PersonAt(1.2, 2.2)})), 0.03);  // cut by the image's border
  // The seat is a fifth of the outline of head and shoulders.
  tests::Box wide = SeatBack(0.25);
  wide.low_m.y() = -0.99;
  EXPECT_GT(HiddenShareOf(Shot({SomebodyAt(2.7)}, 0, {wide})), 0.15);
}

// Two are out of view, and of two who come back the one between their places is somebody already:
// the id that goes to that one.
int IdOfTheFirst(bool other_comes_too) {
  SceneState state, next;
  for (int f = 0; f < 3; ++f) {
    const Scene empty = FindCandidates(Shot({}, f).frame, state, next);
    state = next;
    ConfirmUsers(empty, {}, f / 30.0, state);
  }
  for (const float x_m : {0.0F, -1.2F}) {
    UserTrack user;
    user.id = state.next_id++;
    user.mean_m = {x_m, 0, 3};
    user.seen_s = 3 / 30.0 - 1.0;
    state.users.push_back(user);
  }
  std::vector<CapsulePose> people = {PersonAt(-0.5, 3.1)};
  if (other_comes_too) people.push_back(PersonAt(0.25, 3.1));
  for (CapsulePose& pose : people) pose.left_lift_rad = pose.right_lift_rad = 0.05;
  const CapsuleRender render = Shot(people, 3);
  const Scene scene = FindCandidates(render.frame, state, next);
  EXPECT_EQ(scene.candidates.size(), people.size());
  const auto first = std::min_element(scene.candidates.begin(), scene.candidates.end(),
                                      [](const Candidate& a, const Candidate& b) {
                                        return a.region.mean_m.x() < b.region.mean_m.x();
                                      });
  return ConfirmUsers(scene, {&*first}, render.frame.time_s, next).at(0);
}

TEST(ConfirmUsers, WhoIsNobodyYetMayBeOneOfTheLostToo) {
  EXPECT_EQ(IdOfTheFirst(false), 1);  // half a metre away, not seven tenths
  EXPECT_EQ(IdOfTheFirst(true), 2);   // the other one stands where the first was lost
}

// What is 3 m away, seen through openings in a board 2 m away.
PointGrid GridBehindBoard(const std::vector<tests::Box>& openings) {
  DepthFrame frame;
  frame.camera = KinectV1Camera(320, 240);
  frame.depth_mm.assign(320 * 240, 2000);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d p_m = BackProject(frame.camera, u, v, 3000);
      for (const tests::Box& box : openings) {
        const bool within =
            (p_m.array() >= box.low_m.array()).all() && (p_m.array() <= box.high_m.array()).all();
        if (within) frame.depth_mm[static_cast<size_t>(v * 320 + u)] = 3000;
      }
    }
  }
  return MakePointGrid(frame.view(), frame.camera, 6.0F);
}

Region RegionIn(const PointGrid& grid, const tests::Box& opening) {
  std::vector<int> cells;
  for (int i = 0; i < grid.cells(); ++i) {
    const Eigen::Array3d p_m = grid.at(i).cast<double>().array();
    if ((p_m >= opening.low_m.array()).all() && (p_m <= opening.high_m.array()).all())
      cells.push_back(i);
  }
  return MakeRegion(grid, std::move(cells));
}

TEST(MostlyOf, NothingIsNobodys) { EXPECT_EQ(MostlyOf(Region{}, std::vector<int>{0, 0}, 1), -1); }

TEST(JoinBelow, LegsThatWereTakenAreNoBodyWithLegsOfItsOwn) {
  const tests::Box torso{{-0.3, 0.45, 2.5}, {0.3, 1.05, 3.5}},
      hips{{-0.3, 0, 2.5}, {0.3, 0.25, 3.5}}, shins{{-0.15, -0.35, 2.5}, {0.15, -0.2, 3.5}},
      other{{-1.4, -0.5, 2.5}, {-1.0, 0.8, 3.5}};
  const PointGrid grid = GridBehindBoard({torso, hips, shins, other});
  std::vector<Region> regions;
  for (const tests::Box& box : {torso, hips, shins, other}) regions.push_back(RegionIn(grid, box));
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  for (const int cell : regions[3].cells) owner[static_cast<size_t>(cell)] = 0;
  const std::vector<int> known = owner;
  const size_t trunk = regions[0].cells.size() + regions[1].cells.size();
  const size_t legs = regions[2].cells.size();
  const std::vector<Region> joined = JoinBelow(grid, std::move(regions), 1, owner);
  ASSERT_EQ(joined.size(), 3U);
  EXPECT_EQ(joined[0].cells.size(), trunk);
  EXPECT_EQ(joined[1].cells.size(), legs);  // too far below the torso
  EXPECT_EQ(owner, known);
}

}  // namespace
}  // namespace ossa::depth
