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

// The regions that are left of a tracked body and of a piece 0.3 m behind its side, which is within
// an arm's reach. A second track is lost; it was last seen at `lost_at_m`.
size_t MergePieceBehind(const Eigen::Vector3f& lost_at_m) {
  const tests::Box body{{-0.2, -0.6, 3.0}, {0.2, 0.6, 3.1}},
      piece{{0.25, 0.0, 3.3}, {0.55, 0.3, 3.4}};
  const PointGrid grid = GridOf(Shot({}, 0, {body, piece}));
  const auto cells_between = [&](float near_m, float far_m) {
    std::vector<int> cells;
    for (int i = 0; i < grid.cells(); ++i) {
      const Eigen::Vector3f& p = grid.at(i);
      if (p.z() > near_m && p.z() < far_m && std::abs(p.y()) < 0.62F && std::abs(p.x()) < 0.6F)
        cells.push_back(i);
    }
    return depth::MakeRegion(grid, std::move(cells));
  };
  std::vector<Region> regions{cells_between(2.9F, 3.15F), cells_between(3.2F, 3.45F)};
  std::vector<int> owner(static_cast<size_t>(grid.cells()), -1);
  for (const int cell : regions[0].cells) owner[static_cast<size_t>(cell)] = 0;
  Track user, lost;
  user.mean_m = regions[0].mean_m;
  lost.mean_m = lost_at_m;
  RoomShape shape;
  shape.plane_of.assign(owner.size(), -1);
  return MergePieces(grid, std::move(regions), shape, owner, {user, lost}, 0.1).size();
}

TEST(MergePieces, LeavesAPieceWhereALostTrackMayComeIntoViewAgain) {
  EXPECT_EQ(MergePieceBehind({0.5F, 0.0F, 3.5F}), 2U);
  EXPECT_EQ(MergePieceBehind({-2.0F, 0.0F, 3.5F}), 1U);  // too far away: it is the user's hand
}

TEST(FindMainOwner, RegionWithoutCellsHasNone) {
  EXPECT_EQ(FindMainOwner(Region{}, std::vector<int>{0, 0}, 1), -1);
}

}  // namespace
}  // namespace ossa::people
