// A person behind the back of a seat.
#include "tools/people/planar_occluder.h"

#include "tests/tools/people/scenes.h"
#include "tools/people/head_detector.h"

namespace ossa::people {
namespace {

// The back of a seat, frontal, 2.2 m away, with an opening below it.
tests::Box SeatBack(double top_m) { return {{-0.31, -0.2, 2.2}, {0.31, top_m, 2.3}}; }

CapsulePose SomebodyAt(double z_m) {
  CapsulePose pose = PersonAt(0, z_m);
  pose.left_lift_rad = pose.right_lift_rad = 0.05;
  return pose;
}

RoomShape ShapeOf(const PointGrid& grid) {
  depth::FloorState state;
  return depth::FindRoomSurfaces(grid, depth::FindFloor(grid, state));
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

TEST(FitWholePlane, FitsASeatbackButNotAPerson) {
  const CapsuleRender render = Shot({SomebodyAt(2.7)}, 0, {SeatBack(0.2)});
  const PointGrid grid = GridOf(render);
  const RoomShape shape = ShapeOf(grid);
  const auto seat = FitWholePlane(RegionOf(render, grid, false), shape);
  ASSERT_TRUE(seat.has_value());
  EXPECT_NEAR(1 / seat->At(grid.width / 2, grid.height / 2), 2.2, 0.02);
  const Region person = RegionOf(render, grid, true);
  EXPECT_FALSE(FitWholePlane(person, shape).has_value());
  EXPECT_TRUE(StandsBehind(grid, person, *seat));
  const CapsuleRender before = Shot({SomebodyAt(2.0)}, 0, {SeatBack(0.2)});
  EXPECT_FALSE(StandsBehind(GridOf(before), RegionOf(before, GridOf(before), true), *seat));
}

TEST(ProposeCandidates, SeatbackIsNotMergedWithThePersonAboveIt) {
  const CapsuleRender render = Shot({SomebodyAt(2.7)}, 0, {SeatBack(0.27)});
  const Proposed proposed = ProposeAlone(render);
  const Scene& scene = proposed.scene;
  const auto has = [&](bool board, bool high) {
    return std::find_if(proposed.candidates.begin(), proposed.candidates.end(),
                        [&](const Candidate& candidate) {
                          return candidate.plane.has_value() == board &&
                                 (candidate.region.high_m.y() > 0.5F) == high;
                        });
  };
  const auto seat_at = has(true, false), person_at = has(false, true);
  ASSERT_NE(seat_at, proposed.candidates.end());
  ASSERT_NE(person_at, proposed.candidates.end());
  const Candidate &seat = *seat_at, &person = *person_at;
  EXPECT_LT(person.region.area_m2, 0.12F);  // as small as a limb that was cut off
  EXPECT_TRUE(Occludes(scene, seat, person, {}));
  EXPECT_FALSE(Occludes(scene, person, seat, {}));
  for (const int32_t pixel : person.pixels)
    EXPECT_EQ(render.person.data[static_cast<size_t>(pixel)], 1);
}

TEST(FindHeads, FindsAHeadAboveOccludedShoulders) {
  for (const bool hidden : {true, false}) {
    const CapsuleRender render = Shot({SomebodyAt(2.7)}, 0, {SeatBack(0.32)});
    PointGrid grid = GridOf(render);
    const Region head = RegionOf(render, grid, true);
    const Region seat = RegionOf(render, grid, false);
    // Without an occluder a segment that ends so soon has no head on shoulders.
    for (const int cell : seat.cells)
      if (!hidden) grid.point_m[static_cast<size_t>(cell)] *= 4.5F / 2.2F;
    EXPECT_EQ(FindHeads(grid, head).size(), hidden ? 1U : 0U);
  }
}

}  // namespace
}  // namespace ossa::people
