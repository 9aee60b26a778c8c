// Neighbouring pixels a few millimetres apart see the same depths at the same offsets, and their
// answers are averaged over a patch anyhow. Departure from Shotton et al. 2011, who classify each.
#include "forest/sparse_internal.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace ossa::forest {
namespace {

constexpr int kGap_mm = 50;  // between neighbours: an arm before the trunk

// Tiles of 16 × 8 squares, as many pixels as walk at once.
constexpr int kTileColumns = 16;
constexpr int kTileRows = 8;

// Sorts those that walk by tile (counting sort: within a tile they keep their order).
void SortIntoTiles(const ObjectImage& image, int step, SparsePixels* sparse) {
  const int width = kTileColumns * step;
  const int height = kTileRows * step;
  const int columns = image.width / width + 1;
  const auto tile_of = [&](int32_t p) {
    return (p >> 16) / height * columns + (p & 0xffff) / width;
  };
  std::vector<int32_t> next(static_cast<size_t>(columns * (image.height / height + 1)) + 1, 0);
  std::vector<int32_t> rank(sparse->position.size());
  for (size_t i = 0; i < rank.size(); ++i) {
    rank[i] = tile_of(sparse->position[i]);
    ++next[static_cast<size_t>(rank[i]) + 1];
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<int32_t> sorted(rank.size());
  for (size_t i = 0; i < rank.size(); ++i) {
    rank[i] = next[static_cast<size_t>(rank[i])]++;
    sorted[static_cast<size_t>(rank[i])] = sparse->position[i];
  }
  sparse->position = std::move(sorted);
  for (int32_t& from : sparse->from) from = rank[static_cast<size_t>(from)];
}

// The first pixel of each square walks, and every one on another surface than that.
SparsePixels OneOfEachSquare(const ObjectImage& image, std::span<const int32_t> position,
                             int step) {
  SparsePixels sparse;
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

SparsePixels Everyone(std::span<const int32_t> position) {
  SparsePixels all;
  all.position.assign(position.begin(), position.end());
  all.from.resize(position.size());
  std::iota(all.from.begin(), all.from.end(), 0);
  return all;
}

}  // namespace

SparsePixels ChooseSparse(const ObjectImage& image, std::span<const int32_t> position, int step) {
  SparsePixels sparse = step <= 1 ? Everyone(position) : OneOfEachSquare(image, position, step);
  SortIntoTiles(image, step, &sparse);
  return sparse;
}

}  // namespace ossa::forest
