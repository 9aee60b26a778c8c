#include "depth/base/perceptron/convolution.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace ossa {
namespace {

// What outputs read. Where nobody is one window after the other is the same: it is kept once.
struct Windows {
  RowMatrix distinct;                 // a row a window: its cells one after the other
  Eigen::Index count = 0;             // of rows that are used
  std::vector<Eigen::Index> of_cell;  // the row of each output cell
};

// The cells of a window, nought where it reaches out of the map.
void Gather(const FeatureMap& map, int size, int first_row, int first_column, float* window) {
  const auto channels = map.cells.cols();
  const int begin = std::max(0, first_column), end = std::min(map.side, first_column + size);
  for (int down = 0; down < size; ++down, window += size * channels) {
    const int from = first_row + down;
    if (from < 0 || from >= map.side) {
      std::fill_n(window, size * channels, 0.0F);
      continue;
    }
    float* const inside = window + (begin - first_column) * channels;
    std::fill(window, inside, 0.0F);
    float* const beyond = std::copy_n(map.cells.row(from * map.side + begin).data(),
                                      (end - begin) * channels, inside);
    std::fill(beyond, window + size * channels, 0.0F);
  }
}

Windows GatherWindows(const FeatureMap& map, int size, int stride) {
  const int side = map.side / stride, reach = size / 2;
  const auto numbers = static_cast<Eigen::Index>(size) * size * map.cells.cols();
  const size_t bytes = static_cast<size_t>(numbers) * sizeof(float);
  Windows windows{RowMatrix(static_cast<Eigen::Index>(side) * side, numbers), 0, {}};
  windows.of_cell.reserve(static_cast<size_t>(windows.distinct.rows()));
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      float* const window = windows.distinct.data() + windows.count * numbers;
      Gather(map, size, row * stride - reach, column * stride - reach, window);
      const bool is_new = windows.count == 0 || std::memcmp(window, window - numbers, bytes) != 0;
      windows.count += is_new ? 1 : 0;
      windows.of_cell.push_back(windows.count - 1);
    }
  }
  return windows;
}

}  // namespace

FeatureMap Convolution::Run(const FeatureMap& map) const {
  FeatureMap out{map.side / stride, {}};
  if (size == 1 && stride == 1) {
    out.cells = Multiply(map.cells, weight);
    out.cells.rowwise() += bias;
    return out;
  }
  const Windows windows = GatherWindows(map, size, stride);
  const RowMatrix sums = Multiply(windows.distinct.topRows(windows.count), weight);
  out.cells.resize(windows.distinct.rows(), weight.cols());
  for (size_t cell = 0; cell < windows.of_cell.size(); ++cell) {
    out.cells.row(static_cast<Eigen::Index>(cell)) = sums.row(windows.of_cell[cell]) + bias;
  }
  return out;
}

FeatureMap Rectified(FeatureMap map) {
  map.cells = map.cells.cwiseMax(0.0F);
  return map;
}

FeatureMap Doubled(const FeatureMap& map) {
  FeatureMap out{2 * map.side, RowMatrix(4 * map.cells.rows(), map.cells.cols())};
  for (int row = 0; row < out.side; ++row) {
    for (int column = 0; column < out.side; ++column) {
      out.cells.row(row * out.side + column) = map.cells.row(row / 2 * map.side + column / 2);
    }
  }
  return out;
}

}  // namespace ossa
