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

// The body of a track and a piece behind its side, which no track owns at first. A second track is
// predicted at `other_at_m`.
struct BodyAndPiece {
  BodyAndPiece(const tests::Box& piece, const Eigen::Vector3f& other_at_m) {
    const tests::Box body{{-0.2, -0.6, 3.0}, {0.2, 0.6, 3.1}};
    grid = GridOf(Shot({}, 0, {body, piece}));
    regions = {CellsBetween(2.9F, 3.15F), CellsBetween(3.2F, 3.45F)};
    owner.assign(static_cast<size_t>(grid.cells()), -1);
    Own(0, 0);
    tracks[0].mean_m = regions[0].mean_m;
    tracks[1].mean_m = other_at_m;
  }

  Region CellsBetween(float near_m, float far_m) const {
    std::vector<int> cells;
    for (int i = 0; i < grid.cells(); ++i) {
      const Eigen::Vector3f& p = grid.at(i);
      if (p.z() > near_m && p.z() < far_m && std::abs(p.y()) < 0.62F && std::abs(p.x()) < 0.6F)
        cells.push_back(i);
    }
    return depth::MakeRegion(grid, std::move(cells));
  }
  void Own(size_t region, int track, size_t step = 1) {
    for (size_t i = 0; i < regions[region].cells.size(); i += step)
      owner[static_cast<size_t>(regions[region].cells[i])] = track;
  }
  // The number of regions that are left.
  size_t Merge() const {
    RoomShape shape;
    shape.plane_of.assign(owner.size(), -1);
    return MergePieces(grid, regions, shape, owner, tracks, 0.1).size();
  }
  // The track that owns the region after those were released that hidden tracks may have.
  int OwnerAfterRelease(size_t region) const {
    std::vector<int> left = owner;
    ReleaseReturning(grid, regions, tracks, 0.1, CandidateOptions{}, left);
    return FindMainOwner(regions[region], left, tracks.size());
  }

  PointGrid grid;
  std::vector<Region> regions;
  std::vector<int> owner;
  std::vector<Track> tracks{2};
};

const tests::Box kBeside{{0.25, 0.0, 3.3}, {0.55, 0.3, 3.4}};   // within an arm's reach
const tests::Box kBehind{{0.15, 0.0, 3.35}, {0.3, 0.3, 3.45}};  // closer, but a trunk behind

TEST(MergePieces, LeavesAPieceWhereALostTrackMayComeIntoViewAgain) {
  EXPECT_EQ(BodyAndPiece(kBeside, {0.5F, 0.0F, 3.5F}).Merge(), 2U);
  // Too far away: it is the user's hand.
  EXPECT_EQ(BodyAndPiece(kBeside, {-2.0F, 0.0F, 3.5F}).Merge(), 1U);
}

TEST(MergePieces, LeavesAPieceAtTheDepthOfSomebodyHiddenCloseBehind) {
  EXPECT_EQ(BodyAndPiece(kBehind, {0.0F, 0.0F, 3.4F}).Merge(), 2U);
  EXPECT_EQ(BodyAndPiece(kBehind, {0.0F, 0.0F, 3.05F}).Merge(), 1U);
}

TEST(MergePieces, TreatsSomebodyPartlyHiddenLikeSomebodyLost) {
  const auto merge = [](float full_m2) {
    BodyAndPiece scene(kBehind, {0.0F, 0.0F, 3.4F});
    scene.Own(0, 1, 10);  // a tenth of the body's cells: 0.05 m2
    scene.tracks[1].full_m2 = full_m2;
    return scene.Merge();
  };
  EXPECT_EQ(merge(0.5F), 2U);
  EXPECT_EQ(merge(0.06F), 1U);
}

TEST(ReleaseReturning, TakesFromATrackWhatAHiddenOneMayHave) {
  BodyAndPiece taken(kBehind, {0.0F, 0.0F, 3.4F});
  taken.Own(1, 0);
  EXPECT_EQ(taken.OwnerAfterRelease(1), -1);
  EXPECT_EQ(taken.OwnerAfterRelease(0), 0) << "a track keeps its largest region";
  BodyAndPiece own(kBehind, {0.0F, 0.0F, 3.05F});
  own.Own(1, 0);
  EXPECT_EQ(own.OwnerAfterRelease(1), 0);
}

TEST(FindMainOwner, RegionWithoutCellsHasNone) {
  EXPECT_EQ(FindMainOwner(Region{}, std::vector<int>{0, 0}, 1), -1);
}

}  // namespace
}  // namespace ossa::people
