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

/// Cuts a region into one piece per seed set: each cell goes to the seeds it is joined to by the
/// shortest way over the surface. Cells beyond `reach_m` go to nobody: a person ends somewhere, a
/// sofa does not. seeds[i] are cells of piece i.
std::vector<Region> SplitBySeeds(const PointGrid& grid, const Region& region,
                                 const std::vector<std::vector<int>>& seeds, float reach_m);

}  // namespace ossa::depth
