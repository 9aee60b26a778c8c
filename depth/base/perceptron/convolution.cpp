#include "depth/base/perceptron/convolution.h"

namespace ossa {

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
