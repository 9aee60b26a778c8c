#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "tools/people/geometry.h"
#include "tools/people/options.h"

namespace ossa::people {

/// A head detected by shape, from any side: a blob of about 20 cm, free at its sides and above,
/// with something broader below.
struct HeadBlob {
  int cell = 0;
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();  // on the surface
  float score = 0;                                       // [0, 1]
};

/// Non-maximum suppression: of heads in order of preference, those that are not near a kept one.
template <typename IsNear>
std::vector<HeadBlob> SuppressNearbyHeads(const std::vector<HeadBlob>& sorted,
                                          const IsNear& is_near) {
  std::vector<HeadBlob> kept;
  for (const HeadBlob& head : sorted) {
    const bool near = std::any_of(kept.begin(), kept.end(),
                                  [&](const HeadBlob& other) { return is_near(head, other); });
    if (!near) kept.push_back(head);
  }
  return kept;
}

/// Heads of a region by shape, best first.
std::vector<HeadBlob> FindHeads(const PointGrid& grid, const Region& region,
                                const HeadOptions& options = {});

}  // namespace ossa::people
