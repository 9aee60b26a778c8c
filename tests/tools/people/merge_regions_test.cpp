// Merging of regions by predicted tracks.
#include "tools/people/merge_regions.h"

#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

// The visible parts of a wide object at both sides of a post: the left one is of a track that was
// larger before, the right one is a stride from the track's predicted place.
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
    pieces.push_back(depth::MakeRegion(grid, std::move(cells)));
  }
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  for (const int cell : pieces[0].cells) owner[static_cast<size_t>(cell)] = 0;
  Track user;
  user.mean_m = pieces[0].mean_m;
  return MergeByTracks(grid, std::move(pieces), owner, {user}, 0.0);
}

TEST(MergeByTracks, MergesARegionThatAppearsAtTheOtherSideOfAnOccluder) {
  const tests::Box post{{-0.1, -0.9, 2.0}, {0.1, 0.9, 2.05}};
  EXPECT_EQ(BroadBehind({post}).size(), 1U);
}

TEST(MergeByTracks, LeavesARegionBesideWithoutAnOccluderBetween) {
  EXPECT_EQ(BroadBehind({}).size(), 2U);
}

TEST(FindMainOwner, RegionWithoutCellsHasNone) {
  EXPECT_EQ(FindMainOwner(Region{}, std::vector<int>{0, 0}, 1), -1);
}

}  // namespace
}  // namespace ossa::people
