// Heads by shape, and what grows from seeds.
#include "tools/people/split_regions.h"

#include "tests/tools/people/scenes.h"
#include "tools/people/head_detector.h"

namespace ossa::people {
namespace {

TEST(SplitBySeeds, EntersWhatStoodThereBeforeByARimOnly) {
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
  EXPECT_GT(grown(person), 0.8);  // half a metre over the surface is nearly all of it
  person.background = &stood;
  EXPECT_LT(grown(person), 0.4);  // a rim of 6 cm of 35
}

TEST(FindHeads, IsWhereTheHeadIs) {
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
