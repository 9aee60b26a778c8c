// Upsamples labels from samples to pixels. Most pixels are between four samples of the same label;
// for the others, bilinear interpolation of the samples' masses decides among their labels.
#include <algorithm>
#include <array>

#include "forest/classification/smoothed_masses_internal.h"

namespace ossa::forest {
namespace {

// Several labels; a class with this number would only cost time; by convention
constexpr uint8_t kMixed = 255;

// For the square between the cells (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1), x, y >= -1: the
// common label of all samples, or kMixed.
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

// Four samples and their masses for each other's labels: shared by all pixels between them.
struct Quad {
  int32_t row = -2;                   // row that it was computed for; stale for other rows
  int32_t count = 0;                  // number of existing samples
  std::array<int32_t, 4> corner{};    // corner of each: 0 to 3, row by row
  std::array<int32_t, 4> depth_mm{};  // of each
  std::array<uint8_t, 4> label{};     // of each
  std::array<std::array<uint32_t, 4>, 4> mass{};  // label of one × sample
};

void FillQuad(const SparsePixels& sparse, const SmoothMasses& smooth, int32_t x, int32_t y,
              Quad* quad) {
  quad->row = y;
  quad->count = 0;
  std::array<const uint16_t*, 4> mass{};
  for (int corner = 0; corner < 4; ++corner) {
    const int cell_x = x + corner % 2;
    const int cell_y = y + corner / 2;
    const int32_t sample = sparse.SampleAt(cell_x, cell_y);
    if (sample == SparsePixels::kNone) continue;
    const auto s = static_cast<size_t>(sample);
    const auto k = static_cast<size_t>(quad->count++);
    mass[k] = smooth.mass.data() + s * smooth.stride;
    quad->corner[k] = corner;
    quad->depth_mm[k] = sparse.grid.depth_mm[sparse.grid.At(cell_x, cell_y)];
    quad->label[k] = smooth.label[s];
  }
  const auto count = static_cast<size_t>(quad->count);
  for (size_t c = 0; c < count; ++c) {
    const size_t label = quad->label[c];
    for (size_t k = 0; k < count; ++k) quad->mass[c][k] = label > 0 ? mass[k][label - 1] : 0U;
  }
}

// The label with the largest bilinear mass, among samples on the pixel's surface; 0 if there are
// none.
uint8_t LabelBetween(const Quad& quad, const Between& x, const Between& y, int depth_mm) {
  const std::array<uint32_t, 2> across = {static_cast<uint32_t>(8 - x.eighths),
                                          static_cast<uint32_t>(x.eighths)};
  const std::array<uint32_t, 2> down = {static_cast<uint32_t>(8 - y.eighths),
                                        static_cast<uint32_t>(y.eighths)};
  const auto count = static_cast<size_t>(quad.count);
  std::array<uint32_t, 4> weight{};
  std::array<bool, 4> is_near{};
  for (size_t k = 0; k < count; ++k) {
    const auto corner = static_cast<size_t>(quad.corner[k]);
    is_near[k] = SameSurface(quad.depth_mm[k], depth_mm);
    weight[k] = is_near[k] ? across[corner % 2] * down[corner / 2] : 0;
  }
  uint32_t most = 0;
  uint8_t best = 0;
  for (size_t c = 0; c < count; ++c) {
    const std::array<uint32_t, 4>& of = quad.mass[c];
    const uint32_t mass =
        is_near[c] ? weight[0] * of[0] + weight[1] * of[1] + weight[2] * of[2] + weight[3] * of[3]
                   : 0;
    const bool wins = mass > most || (mass == most && mass > 0 && quad.label[c] < best);
    most = wins ? mass : most;
    best = wins ? quad.label[c] : best;
  }
  return best;
}

// Assigns each pixel of a row its sample's label, and collects the pixels between samples of
// several labels that are not samples. Branch-free, because outcomes are unpredictable. Returns the
// number of collected pixels.
size_t LabelRow(std::span<const int32_t> position, const int32_t* from, const SparsePixels& sparse,
                const uint8_t* row_between, const uint8_t* sample_label, uint8_t* label,
                uint32_t* picked) {
  const int32_t* sample_position = sparse.position.data();
  const Between* column = sparse.column.data();
  size_t count = 0;
  for (size_t i = 0; i < position.size(); ++i) {
    const int32_t p = position[i];
    const int32_t sample = from[i];
    const bool is_mixed = row_between[column[p & 0xffff].low + 1] == kMixed;
    label[i] = sample_label[sample];
    picked[count] = static_cast<uint32_t>(i);
    count += static_cast<size_t>(is_mixed) & static_cast<size_t>(sample_position[sample] != p);
  }
  return count;
}

}  // namespace

std::vector<uint8_t> LabelPixels(const ObjectImage& image, std::span<const int32_t> position,
                                 const SparsePixels& sparse, const SmoothMasses& smooth) {
  const std::vector<uint8_t> between = LabelsBetween(sparse, smooth);
  const auto columns = static_cast<size_t>(sparse.grid.width + 1);
  std::vector<Quad> quads(columns);
  std::vector<uint8_t> labels(position.size());
  std::vector<uint32_t> picked(sparse.column.size());
  ForRows(position, kPositionRow, [&](int y, size_t first, size_t last) {
    const Between& row = sparse.row[static_cast<size_t>(y)];
    const uint16_t* depth_mm = &image.depth_mm[image.At(0, y)];
    const size_t count = LabelRow(position.subspan(first, last - first), &sparse.from[first],
                                  sparse, &between[static_cast<size_t>(row.low + 1) * columns],
                                  smooth.label.data(), &labels[first], picked.data());
    for (size_t k = 0; k < count; ++k) {
      const size_t i = first + picked[k];
      const int x = position[i] & 0xffff;
      const Between& column = sparse.column[static_cast<size_t>(x)];
      Quad& quad = quads[static_cast<size_t>(column.low + 1)];
      if (quad.row != row.low) FillQuad(sparse, smooth, column.low, row.low, &quad);
      const uint8_t label = LabelBetween(quad, column, row, depth_mm[x]);
      if (label != 0) labels[i] = label;
    }
  });
  return labels;
}

}  // namespace ossa::forest
