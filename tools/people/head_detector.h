#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"

namespace ossa::people {

/// A place that is shaped like a head from any side: a blob of about 20 cm, free at its sides and
/// above, with something broader below.
struct HeadBlob {
  int cell = 0;
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  // on the surface
  float score = 0;                                       // [0, 1]
};

/// Heads of a region by its shape, best first.
std::vector<HeadBlob> FindHeads(const PointGrid& grid, const Region& region,
                                const HeadOptions& options = {});

}  // namespace ossa::people
