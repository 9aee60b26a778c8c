// Head detection by shape, and growing of seeds.
#include "tools/people/split_regions.h"

#include <algorithm>
#include <utility>

#include "tests/tools/people/scenes.h"
#include "tools/people/head_detector.h"

namespace ossa::people {
namespace {

TEST(SplitBySeeds, ExtendsIntoTheBackgroundByARimOnly) {
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
  EXPECT_GT(grown(person), 0.8);  // growing by half a metre covers nearly all of it
  person.background = &stood;
  EXPECT_LT(grown(person), 0.4);  // a rim of 6 cm of 35
}

// Brute force: the shortest paths over the surface from a seed, by relaxing all steps until nothing
// changes.
std::vector<float> Ways_m(const PointGrid& grid, const std::vector<uint8_t>& member,
                          const std::vector<int>& seed, const SeedOptions& options) {
  std::vector<float> way_m(member.size(), 1e9F);
  for (const int cell : seed) way_m[static_cast<size_t>(cell)] = 0.0F;
  bool shortened = true;
  while (std::exchange(shortened, false)) {
    for (int i = 0; i < 8 * grid.cells(); ++i) {
      const int from = i / 8, x = from % grid.width + depth::kStepsOverGaps[i % 8][0];
      const int y = from / grid.width + depth::kStepsOverGaps[i % 8][1];
      if (!grid.Contains(x, y)) continue;
      const auto to = static_cast<size_t>(grid.cell(x, y));
      if (!member[static_cast<size_t>(from)] || !member[to]) continue;
      Eigen::Vector3f step_m = grid.at(grid.cell(x, y)) - grid.at(from);
      step_m.x() *= options.sideways;
      const float jump_m = Continuous(grid, from, grid.cell(x, y)) ? 0.0F : options.jump_cost_m;
      const float there_m = way_m[static_cast<size_t>(from)] + step_m.norm() + jump_m;
      shortened |= there_m < way_m[to];
      way_m[to] = std::min(way_m[to], there_m);
    }
  }
  return way_m;
}

TEST(SplitBySeeds, AssignsCellsToTheSeedWithTheShortestPath) {
  const PointGrid grid = GridOf(Shot({PersonAt(-0.25, 2.5), PersonAt(0.2, 2.4)}));
  std::vector<uint8_t> member(static_cast<size_t>(grid.cells()), 0);
  std::vector<int> all;
  std::vector<Seed> seeds(2, {{}, 1e6F, nullptr});
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i) || grid.z(i) > 2.8F) continue;
    member[static_cast<size_t>(i)] = 1;
    all.push_back(i);
    const float x_m = grid.at(i).x();
    if (std::abs(x_m) > 0.15F && grid.at(i).y() > 0.2F) seeds[x_m < 0 ? 0 : 1].cells.push_back(i);
  }
  ASSERT_FALSE(seeds[0].cells.empty() || seeds[1].cells.empty());
  const SeedOptions options;
  const auto pieces = SplitBySeeds(grid, MakeRegion(grid, all), seeds, options);
  const auto first_m = Ways_m(grid, member, seeds[0].cells, options);
  const auto second_m = Ways_m(grid, member, seeds[1].cells, options);
  constexpr float kAsNear_m = 1e-4F;  // either is right
  for (const int cell : all) {
    const float more_m = second_m[static_cast<size_t>(cell)] - first_m[static_cast<size_t>(cell)];
    if (std::abs(more_m) < kAsNear_m) continue;
    const std::vector<int>& mine = pieces[more_m > 0 ? 0 : 1].cells;
    EXPECT_TRUE(std::binary_search(mine.begin(), mine.end(), cell)) << cell << " " << more_m;
  }
}

// A board of 3.2 m and a head at its one end: what is beyond a person's reach of it.
TEST(CutAtSeeds, KeepsWhatIsBeyondReachIfItMayBeAPerson) {
  const PointGrid grid = GridOf(Shot({}, 0, {{{-1.6, -0.5, 3.0}, {1.6, 0.5, 3.05}}}));
  std::vector<int> all;
  std::vector<int> at_end;
  for (int i = 0; i < grid.cells(); ++i) {
    if (!grid.valid(i) || grid.z(i) > 3.1F || std::abs(grid.at(i).y()) > 0.5F) continue;
    all.push_back(i);
    if (grid.at(i).x() > 1.4F) at_end.push_back(i);
  }
  const Region board = MakeRegion(grid, all);
  ASSERT_GT(board.area_m2, 2.5F);
  const auto cut = [&](float reach_m) {
    return CutAtSeeds(grid, board, {{at_end, reach_m, nullptr}}, CandidateOptions{});
  };
  const std::vector<Region> halves = cut(2.0F);  // 1.3 m: horizontal steps cost more
  ASSERT_EQ(halves.size(), 2U);
  EXPECT_EQ(halves[0].cells.size() + halves[1].cells.size(), all.size());
  EXPECT_LT(halves[1].mean_m.x(), halves[0].mean_m.x());
  const float all_but_a_strip_m = 1.5F * 2.99F;  // of the 3.0 m beside the head
  EXPECT_EQ(cut(all_but_a_strip_m).size(), 1U) << "what is left is too narrow for a person";
}

TEST(FindHeads, FindsTheHead) {
  const CapsuleRender render = Shot({PersonAt(0.2, 2.5)});
  const Proposed proposed = ProposeAlone(render);
  ASSERT_EQ(proposed.candidates.size(), 1U);
  const auto heads = FindHeads(proposed.scene.grid, proposed.candidates[0].region);
  ASSERT_EQ(heads.size(), 1U);
  const Eigen::Vector3d head = render.joints[0][recon::Joint::kHead];
  // On the surface of a head of about 10 cm radius.
  EXPECT_LT((heads[0].position_m.cast<double>() - head).norm(), 0.16);
}

}  // namespace
}  // namespace ossa::people
