// Regions of a person whose middle is occluded.
#include "tools/people/occlusion_merge.h"

#include <cmath>

#include "tests/tools/people/scenes.h"

namespace ossa::people {
namespace {

// Cells in which two images differ in depth, as connected regions.
std::vector<Region> Changed(const PointGrid& before, const PointGrid& now) {
  std::vector<uint8_t> ignore(static_cast<size_t>(now.cells()), 0);
  for (int i = 0; i < now.cells(); ++i)
    ignore[static_cast<size_t>(i)] = std::abs(now.z(i) - before.z(i)) < 0.1F;
  return depth::FindConnectedRegions(now, ignore, 0.02F);
}

// The visible parts of a tall object above and below a board.
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

TEST_F(Behind, MergesPiecesAtBothSidesOfAnOccluder) {
  ASSERT_EQ(pieces_.size(), 2U);
  EXPECT_EQ(MergeBesideOccluder(grid_, pieces_, all_, nobody_, 0).size(), 1U);
}

TEST_F(Behind, OwnedRegionsAndBackgroundAreNotMerged) {
  const std::vector<uint8_t> none(all_.size(), 0);
  EXPECT_EQ(MergeBesideOccluder(grid_, pieces_, none, nobody_, 0).size(), pieces_.size());
  for (const int cell : pieces_[0].cells) nobody_[static_cast<size_t>(cell)] = 0;
  EXPECT_GT(MergeBesideOccluder(grid_, pieces_, all_, nobody_, 1).size(), 1U);
}

TEST_F(Behind, MergesLegsBelowATableWithThePersonAtIt) {
  ASSERT_EQ(pieces_.size(), 2U);
  const size_t body = pieces_[0].mean_m.y() > pieces_[1].mean_m.y() ? 0 : 1;
  for (const int cell : pieces_[body].cells) nobody_[static_cast<size_t>(cell)] = 0;
  EXPECT_EQ(MergeBelowOccluder(grid_, pieces_, 1, nobody_).size(), 1U);
  for (const int cell : pieces_[1 - body].cells) EXPECT_EQ(nobody_[static_cast<size_t>(cell)], 0);
}

TEST_F(Behind, TableLegsAreTooThinToMerge) {
  const Region& legs = pieces_[pieces_[0].mean_m.y() < pieces_[1].mean_m.y() ? 0 : 1];
  const int middle = legs.cells[legs.cells.size() / 2] % grid_.width;
  std::vector<int> thin;
  for (const int cell : legs.cells) {
    if (std::abs(cell % grid_.width - middle) < 2) thin.push_back(cell);  // 6 cm
  }
  auto regions = pieces_;
  regions[&legs == &pieces_[0] ? 0 : 1] = depth::MakeRegion(grid_, thin);
  EXPECT_EQ(MergeBelowOccluder(grid_, regions, 0, nobody_).size(), 2U);
}

// Regions of new objects in front of a wall that is visible between them, merged: the number that
// remains.
size_t JoinedOf(const tests::Box& a, const tests::Box& b) {
  const PointGrid grid = GridOf(Shot({}, 0, {a, b}));
  auto regions = Changed(GridOf(Shot({})), grid);
  EXPECT_EQ(regions.size(), 2U);
  const auto cells = static_cast<size_t>(grid.cells());
  return MergeBesideOccluder(grid, std::move(regions), std::vector<uint8_t>(cells, 1),
                             std::vector<int>(cells, -1), 0)
      .size();
}

TEST(MergeBesideOccluder, MergesRegionsAboveEachOtherAtOnePlace) {
  const tests::Box lower{{-0.1, -0.9, 3.0}, {0.1, -0.3, 3.2}};
  EXPECT_EQ(JoinedOf(lower, {{-0.2, 0.1, 3.0}, {0.0, 0.5, 3.2}}), 1U);
  EXPECT_EQ(JoinedOf(lower, {{-0.2, 0.1, 3.6}, {0.0, 0.5, 3.8}}), 2U);     // behind,
  EXPECT_EQ(JoinedOf(lower, {{0.45, 0.1, 3.0}, {0.65, 0.5, 3.2}}), 2U);    // to the side,
  EXPECT_EQ(JoinedOf(lower, {{0.15, -0.7, 3.0}, {0.35, -0.1, 3.2}}), 2U);  // half beside
}

TEST(MergeBesideOccluder, MergesAWalkerAtBothSidesOfANearerPerson) {
  const tests::Box post{{-0.17, -0.9, 2.0}, {0.17, 0.9, 2.05}};
  const tests::Box strider{{-0.38, -0.8, 3.2}, {0.38, 0.3, 3.4}};
  const PointGrid grid = GridOf(Shot({}, 0, {post, strider}));
  auto regions = Changed(GridOf(Shot({}, 0, {post})), grid);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_GT(std::abs(regions[0].mean_m.x() - regions[1].mean_m.x()), 0.6F);
  const auto cells = static_cast<size_t>(grid.cells());
  EXPECT_EQ(MergeBesideOccluder(grid, std::move(regions), std::vector<uint8_t>(cells, 1),
                                std::vector<int>(cells, -1), 0)
                .size(),
            1U);
}

// Two regions at different distances, an occluder between them, and another object in a gap of it.
bool IsOccludedWithAGapTo(uint16_t gap_mm) {
  const depth::Camera camera = depth::KinectV1Camera(160, 120);
  depth::DepthFrame frame;
  frame.camera = camera;
  frame.depth_mm.resize(160 * 120);
  const auto paint = [&](int from, int to, uint16_t mm) {
    for (int v = 40; v < 80; ++v) {
      for (int u = from; u < to; ++u) frame.depth_mm[static_cast<size_t>(v * 160 + u)] = mm;
    }
  };
  paint(30, 50, 3200);
  paint(50, 100, 2000);
  paint(70, 78, gap_mm);
  paint(100, 120, 3800);
  const PointGrid grid = depth::MakePointGrid(frame.view(), camera, 6.0F);
  std::vector<int> left, right;
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i)) continue;
    if (i % grid.width * grid.step < 50) left.push_back(i);
    if (i % grid.width * grid.step >= 100) right.push_back(i);
  }
  return IsOccludedBetween(grid, depth::MakeRegion(grid, left), depth::MakeRegion(grid, right), {});
}

TEST(IsOccludedBetween, IsFalseIfTheBackgroundIsVisibleBetween) {
  EXPECT_TRUE(IsOccludedWithAGapTo(0)) << "a shadow";
  EXPECT_TRUE(IsOccludedWithAGapTo(3900)) << "about as far as the farther piece";
  EXPECT_FALSE(IsOccludedWithAGapTo(5500)) << "the wall";
}

TEST(IsOneAboveOther, IsHorizontalDistanceAlsoForASensorTiltedDown) {
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
  EXPECT_TRUE(IsOneAboveOther(grid, trousers, shirt));
  EXPECT_TRUE(IsOneAboveOther(grid, shirt, trousers));
  EXPECT_FALSE(IsOneAboveOther(grid, trousers, piece(1.2F, 0.5F)));
  EXPECT_FALSE(IsOneAboveOther(grid, trousers, piece(0.6F, 0.2F)));
}

TEST(MergeBesideOccluder, ObjectsWithTheWallBetweenThemStayApart) {
  const CapsuleRender render =
      Shot({}, 0, {{{-0.3, -0.6, 3.0}, {-0.1, 0.2, 3.2}}, {{0.1, -0.6, 3.0}, {0.3, 0.2, 3.2}}});
  const PointGrid grid = GridOf(render);
  auto regions = Changed(GridOf(Shot({})), grid);
  ASSERT_EQ(regions.size(), 2U);
  const auto cells = static_cast<size_t>(grid.cells());
  EXPECT_EQ(MergeBesideOccluder(grid, std::move(regions), std::vector<uint8_t>(cells, 1),
                                std::vector<int>(cells, -1), 0)
                .size(),
            2U);
}

// An object 3 m away, seen through openings in a board 2 m away.
PointGrid GridBehindBoard(const std::vector<tests::Box>& openings) {
  DepthFrame frame;
  frame.camera = KinectV1Camera(320, 240);
  frame.depth_mm.assign(320 * 240, 2000);
  for (int v = 0; v < 240; ++v) {
    for (int u = 0; u < 320; ++u) {
      const Eigen::Vector3d p_m = depth::BackProject(frame.camera, u, v, 3000);
      for (const tests::Box& box : openings) {
        const bool within =
            (p_m.array() >= box.low_m.array()).all() && (p_m.array() <= box.high_m.array()).all();
        if (within) frame.depth_mm[static_cast<size_t>(v * 320 + u)] = 3000;
      }
    }
  }
  return depth::MakePointGrid(frame.view(), frame.camera, 6.0F);
}

Region RegionIn(const PointGrid& grid, const tests::Box& opening) {
  std::vector<int> cells;
  for (int i = 0; i < grid.cells(); ++i) {
    const Eigen::Array3d p_m = grid.at(i).cast<double>().array();
    if ((p_m >= opening.low_m.array()).all() && (p_m <= opening.high_m.array()).all())
      cells.push_back(i);
  }
  return depth::MakeRegion(grid, std::move(cells));
}

TEST(MergeBelowOccluder, DoesNotMergeTakenLegsWithABodyThatHasLegs) {
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
  const std::vector<Region> joined = MergeBelowOccluder(grid, std::move(regions), 1, owner);
  ASSERT_EQ(joined.size(), 3U);
  EXPECT_EQ(joined[0].cells.size(), trunk);
  EXPECT_EQ(joined[1].cells.size(), legs);  // too far below the torso
  EXPECT_EQ(owner, known);
}

}  // namespace
}  // namespace ossa::people
