#include "depth/base/perceptron/convolution.h"

#include <algorithm>
#include <utility>

namespace ossa {
namespace {

// Of each output a row: the cells of its window one after the other.
RowMatrix GatherWindows(const FeatureMap& map, int size, int stride) {
  const int side = map.side / stride, reach = size / 2;
  const auto channels = map.cells.cols();
  RowMatrix windows = RowMatrix::Zero(static_cast<Eigen::Index>(side) * side,
                                      static_cast<Eigen::Index>(size) * size * channels);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const int first = column * stride - reach;
      const int begin = std::max(0, first), end = std::min(map.side, first + size);
      float* const window = windows.row(row * side + column).data();
      for (int down = 0; down < size; ++down) {
        const int from = row * stride - reach + down;
        if (from < 0 || from >= map.side) continue;
        std::copy_n(map.cells.row(from * map.side + begin).data(), (end - begin) * channels,
                    window + (down * size + begin - first) * channels);
      }
    }
  }
  return windows;
}

}  // namespace

FeatureMap Convolution::Run(const FeatureMap& map) const {
  FeatureMap out{map.side / stride, {}};
  out.cells = size == 1 && stride == 1 ? Multiply(map.cells, weight)
                                       : Multiply(GatherWindows(map, size, stride), weight);
  out.cells.rowwise() += bias;
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
