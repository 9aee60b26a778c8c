// One body that an arm, or an object held before it, divides into several regions.
#include "tools/people/join_pieces.h"

#include "tests/tools/people/scenes.h"
#include "tools/people/split_regions.h"

namespace ossa::people {
namespace {

constexpr int kWidth = 160, kHeight = 120;

// An object at one depth in an otherwise empty image: columns and rows, [from, to).
struct Patch {
  int left, right, top, bottom;
  uint16_t mm;
};

PointGrid Painted(const std::vector<Patch>& patches) {
  depth::DepthFrame frame;
  frame.camera = depth::KinectV1Camera(kWidth, kHeight);
  frame.depth_mm.resize(static_cast<size_t>(kWidth) * kHeight);
  for (const Patch& patch : patches) {
    for (int v = patch.top; v < patch.bottom; ++v) {
      for (int u = patch.left; u < patch.right; ++u)
        frame.depth_mm[static_cast<size_t>(v * kWidth + u)] = patch.mm;
    }
  }
  return depth::MakePointGrid(frame.view(), frame.camera, 6.0F);
}

std::vector<Region> Pieces(const PointGrid& grid) {
  const std::vector<uint8_t> none(static_cast<size_t>(grid.cells()), 0);
  return depth::FindConnectedRegions(grid, none, JoinOptions{}.piece_m2);
}

// Two objects 6 rows apart, with `between` in the gap.
bool DoMeet(uint16_t lower_mm, uint16_t between_mm) {
  const PointGrid grid =
      Painted({{60, 100, 20, 50, 1000}, {60, 100, 56, 90, lower_mm}, {0, 160, 50, 56, between_mm}});
  const auto pieces = Pieces(grid);
  size_t upper = pieces.size(), lower = pieces.size();
  for (size_t i = 0; i < pieces.size(); ++i) {
    const int row = pieces[i].cells.front() / grid.width;
    if (row == 20 * grid.height / kHeight) upper = i;
    if (row == 56 * grid.height / kHeight) lower = i;
  }
  EXPECT_LT(std::max(upper, lower), pieces.size());
  const auto meeting = FindAdjacentPieces(grid, pieces, {});
  return std::ranges::count(meeting[upper], lower) == 1 &&
         std::ranges::count(meeting[lower], upper) == 1;
}

TEST(FindAdjacentPieces, SpansAnOccluderAndItsShadow) {
  EXPECT_TRUE(DoMeet(1000, 700));  // an arm
  EXPECT_TRUE(DoMeet(1000, 0));    // no readings
  EXPECT_TRUE(DoMeet(1300, 0));    // a trunk below the arm that occludes its upper half
}

TEST(FindAdjacentPieces, DoesNotSpanVisibleBackgroundOrLargeDepthDifferences) {
  EXPECT_FALSE(DoMeet(1000, 2000));
  EXPECT_FALSE(DoMeet(1700, 0));
}

TEST(FindAdjacentPieces, DoesNotSpanMoreThanAnArm) {
  const PointGrid grid = Painted({{60, 100, 10, 40, 1000}, {60, 100, 80, 110, 1000}});
  for (const auto& others : FindAdjacentPieces(grid, Pieces(grid), {})) EXPECT_TRUE(others.empty());
}

// Head and trunk, each too small for a person, below and above an arm, and an object beside that
// touches the trunk.
class CutInTwo : public testing::Test {
 protected:
  static constexpr Patch kHead{60, 84, 10, 30, 1000}, kTrunk{50, 90, 36, 60, 1000},
      kThing{90, 130, 36, 60, 1200};

  // The score grows with the share of head and trunk; with the object it is 0.
  ClassifyRegion Classifier() {
    return [this](Region region) {
      Detection detection;
      detection.verifier = Verifier::kForestAndNetwork;
      const bool has_thing = MeasureShare(region, thing_) > 0;
      detection.evidence.score = has_thing ? 0.0 : static_cast<double>(region.area_m2);
      detection.candidate.region = std::move(region);
      ++asked_;
      return detection;
    };
  }
  std::vector<Detection> Grow() {
    thing_.assign(static_cast<size_t>(grid_.cells()), 0);
    for (int i = 0; i < grid_.cells(); ++i) thing_[static_cast<size_t>(i)] = grid_.z(i) > 1.1F;
    return GrowAcrossDepthEdges(grid_, Pieces(grid_), Classifier(), {});
  }
  PointGrid grid_ = Painted({kHead, kTrunk, kThing});
  std::vector<uint8_t> thing_;
  int asked_ = 0;
};

TEST_F(CutInTwo, AddsPiecesThatRaiseTheScore) {
  const auto wholes = Grow();
  ASSERT_FALSE(wholes.empty());
  const Detection& best = *std::ranges::max_element(wholes, {}, GetPersonScore);
  const Region& whole = best.candidate.region;
  EXPECT_EQ(MeasureShare(whole, thing_), 0.0);
  EXPECT_EQ(whole.cells.size(),
            Pieces(Painted({kHead}))[0].cells.size() + Pieces(Painted({kTrunk}))[0].cells.size());
}

TEST_F(CutInTwo, SinglePiecesAreClassifiedOnlyAtTheImageBorder) {
  grid_ = Painted({kHead});
  ASSERT_FALSE(IsPersonSized(Pieces(grid_)[0], {}));
  EXPECT_TRUE(Grow().empty());
  EXPECT_EQ(asked_, 0);
  grid_ = Painted({{60, 84, 100, kHeight, 1000}});
  ASSERT_FALSE(IsPersonSized(Pieces(grid_)[0], {}));
  EXPECT_EQ(Grow().size(), 1U);
}

TEST_F(CutInTwo, PersonSizedPiecesWithoutNeighboursAreNotTriedAgain) {
  grid_ = Painted({{40, 110, 40, kHeight, 1000}});
  ASSERT_TRUE(IsPersonSized(Pieces(grid_)[0], {}));
  EXPECT_TRUE(Grow().empty());
}

}  // namespace
}  // namespace ossa::people
