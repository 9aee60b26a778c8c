// From samples to pixels. Most pixels lie between four samples of one label; the others get that of
// the four samples' labels which has most mass at them, weighted bilinearly.
#include <algorithm>
#include <array>

#include "forest/smooth_internal.h"

namespace ossa::forest {
namespace {

constexpr uint8_t kMixed = 255;  // more labels than one; a class of this number merely costs time

// Between the cells (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1) for x, y >= -1: the one label
// of all samples there, or kMixed.
std::vector<uint8_t> LabelsBetween(const SparsePixels& sparse, const SmoothMasses& smooth) {
  const auto columns = static_cast<size_t>(sparse.grid.width + 1);
  std::vector<uint8_t> between(columns * static_cast<size_t>(sparse.grid.height + 1), 0);
  for (int y = 0; y < sparse.grid.height; ++y) {
    for (int x = 0; x < sparse.grid.width; ++x) {
      const int32_t sample = sparse.SampleAt(x, y);
      if (sample == SparsePixels::kNone) continue;
      const uint8_t label = smooth.label[static_cast<size_t>(sample)];
      for (size_t corner = 0; corner < 4; ++corner) {
        uint8_t& whole = between[(static_cast<size_t>(y) + corner / 2) * columns +
                                 static_cast<size_t>(x) + corner % 2];
        whole = whole == 0 || whole == label ? label : kMixed;
      }
    }
  }
  return between;
}

// One of the four samples around a pixel.
struct Corner {
  const uint16_t* mass = nullptr;
  uint32_t weight = 0;
  uint8_t label = 0;
};

uint8_t LabelBetween(const SparsePixels& sparse, const SmoothMasses& smooth, const Between& x,
                     const Between& y, int depth_mm) {
  std::array<Corner, 4> corners;
  size_t count = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int cell_x = x.low + corner % 2;
    const int cell_y = y.low + corner / 2;
    const int across = corner % 2 == 0 ? 8 - x.eighths : x.eighths;
    const int down = corner / 2 == 0 ? 8 - y.eighths : y.eighths;
    const int32_t sample = sparse.SampleAt(cell_x, cell_y);
    if (sample == SparsePixels::kNone) continue;
    if (!SameSurface(sparse.grid.depth_mm[sparse.grid.At(cell_x, cell_y)], depth_mm)) continue;
    const auto s = static_cast<size_t>(sample);
    corners[count++] = {smooth.mass.data() + s * smooth.stride,
                        static_cast<uint32_t>(across * down), smooth.label[s]};
  }
  uint32_t most = 0;
  uint8_t best = 0;
  for (size_t c = 0; c < count; ++c) {
    const uint8_t label = corners[c].label;
    if (label == 0 || label == best) continue;
    uint32_t mass = 0;
    for (size_t k = 0; k < count; ++k) mass += corners[k].weight * corners[k].mass[label - 1U];
    if (mass > most || (mass == most && label < best)) {
      most = mass;
      best = label;
    }
  }
  return best;
}

}  // namespace

std::vector<uint8_t> LabelPixels(const ObjectImage& image, std::span<const int32_t> position,
                                 const SparsePixels& sparse, const SmoothMasses& smooth) {
  const std::vector<uint8_t> between = LabelsBetween(sparse, smooth);
  const auto columns = static_cast<size_t>(sparse.grid.width + 1);
  std::vector<uint8_t> labels(position.size());
  ForRows(position, kPositionRow, [&](int y, size_t first, size_t last) {
    const Between& row = sparse.row[static_cast<size_t>(y)];
    const uint8_t* row_between = &between[static_cast<size_t>(row.low + 1) * columns];
    for (size_t i = first; i < last; ++i) {
      const int x = position[i] & 0xffff;
      const Between& column = sparse.column[static_cast<size_t>(x)];
      const auto sample = static_cast<size_t>(sparse.from[i]);
      labels[i] = smooth.label[sample];
      if (row_between[column.low + 1] != kMixed || sparse.position[sample] == position[i]) continue;
      const uint8_t label =
          LabelBetween(sparse, smooth, column, row, image.depth_mm[image.At(x, y)]);
      if (label != 0) labels[i] = label;
    }
  });
  return labels;
}

}  // namespace ossa::forest
