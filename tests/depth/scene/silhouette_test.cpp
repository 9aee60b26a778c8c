// The share of a silhouette occluded by nearer surfaces.
#include "depth/scene/silhouette.h"

#include <gtest/gtest.h>

#include "tests/depth/scene/shots.h"

namespace ossa::depth {
namespace {

// The back of a seat, frontal, 2.2 m away, open below.
tests::Box SeatBack(double top_m) { return {{-0.31, -0.2, 2.2}, {0.31, top_m, 2.3}}; }

CapsulePose SomebodyAt(double z_m) {
  CapsulePose pose = PersonAt(0, z_m);
  pose.left_lift_rad = pose.right_lift_rad = 0.05;
  return pose;
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

double OccludedShare(const CapsuleRender& render) {
  const PointGrid grid = GridOf(render);
  FloorState state;
  return MeasureOccludedShare(grid, FindFloor(grid, state), RegionOf(render, grid, true));
}

TEST(OccludedShare, CountsTheSilhouetteNextToNearerSurfaces) {
  EXPECT_LT(OccludedShare(Shot({SomebodyAt(2.7)})), 0.03);
  EXPECT_LT(OccludedShare(Shot({PersonAt(1.2, 2.2)})), 0.03);  // cut by the image's border
  // The seat is a fifth of the silhouette of head and shoulders.
  tests::Box wide = SeatBack(0.25);
  wide.low_m.y() = -0.99;
  EXPECT_GT(OccludedShare(Shot({SomebodyAt(2.7)}, 0, {wide})), 0.15);
}

}  // namespace
}  // namespace ossa::depth
