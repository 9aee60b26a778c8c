#pragma once
#include <Eigen/Core>
#include <vector>

#include "depth/scene/regions.h"

namespace ossa::depth {

/// A place that looks like a head from any side: a blob of about 20 cm, free at its sides and
/// above, with something broader below.
struct HeadBlob {
  int cell = 0;
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  // on the surface
  float score = 0;                                       // [0, 1]
};

/// Heads of a region, best first, at least 25 cm apart.
std::vector<HeadBlob> FindHeads(const PointGrid& grid, const Region& region);

/// Where a piece begins, and how far it may go from there over the surface.
struct Seed {
  std::vector<int> cells;
  float reach_m = 0;
  const std::vector<uint8_t>* barred = nullptr;  // 1: a cell it enters by a rim only
};

/// Cuts a region into one piece per seed: each cell goes to the seed it is joined to by the
/// shortest way over the surface. Cells beyond reach go to nobody: a person ends somewhere, a sofa
/// does not.
std::vector<Region> SplitBySeeds(const PointGrid& grid, const Region& region,
                                 const std::vector<Seed>& seeds);

}  // namespace ossa::depth
