// Neighbouring pixels a few millimetres apart see the same depths at the same offsets, and their
// answers are averaged over a patch anyhow. Departure from Shotton et al. 2011, who classify each.
#include "forest/sparse_internal.h"

#include <algorithm>
#include <cstdlib>

namespace ossa::forest {
namespace {

constexpr int kGap_mm = 50;  // between neighbours: an arm before the trunk

}  // namespace

SparsePixels ChooseSparse(const ObjectImage& image, std::span<const int32_t> position, int step) {
  SparsePixels sparse;
  if (step <= 1) {
    sparse.position.assign(position.begin(), position.end());
    return sparse;
  }
  const int columns = image.width / step + 1;
  const int rows = image.height / step + 1;
  std::vector<int32_t> walker(static_cast<size_t>(columns) * static_cast<size_t>(rows), -1);
  sparse.from.reserve(position.size());
  for (const int32_t p : position) {
    const int x = p & 0xffff;
    const int y = p >> 16;
    int32_t& first = walker[static_cast<size_t>(y / step * columns + x / step)];
    if (first >= 0) {
      const int32_t q = sparse.position[static_cast<size_t>(first)];
      const int here_mm = image.depth_mm[image.At(x, y)];
      const int there_mm = image.depth_mm[image.At(q & 0xffff, q >> 16)];
      if (std::abs(here_mm - there_mm) <= kGap_mm) {
        sparse.from.push_back(first);
        continue;
      }
    }
    sparse.from.push_back(static_cast<int32_t>(sparse.position.size()));
    if (first < 0) first = sparse.from.back();
    sparse.position.push_back(p);
  }
  return sparse;
}

}  // namespace ossa::forest
