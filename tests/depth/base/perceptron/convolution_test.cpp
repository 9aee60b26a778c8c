#include "depth/base/perceptron/convolution.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

FeatureMap RandomMap(int side, Eigen::Index channels) {
  return {side, RowMatrix::Random(static_cast<Eigen::Index>(side) * side, channels)};
}

Convolution RandomLayer(int size, int stride, Eigen::Index inputs, Eigen::Index outputs) {
  return {size, stride, RowMatrix::Random(size * size * inputs, outputs),
          Eigen::RowVectorXf::Random(outputs)};
}

// By its definition, one product after the other.
float OneByOne(const Convolution& layer, const FeatureMap& map, int row, int column,
               Eigen::Index output) {
  float sum = layer.bias[output];
  for (int down = 0; down < layer.size; ++down) {
    for (int aside = 0; aside < layer.size; ++aside) {
      const int v = row * layer.stride + down - layer.size / 2;
      const int u = column * layer.stride + aside - layer.size / 2;
      if (v < 0 || v >= map.side || u < 0 || u >= map.side) continue;
      for (Eigen::Index input = 0; input < map.cells.cols(); ++input) {
        sum += map.cells(v * map.side + u, input) *
               layer.weight((down * layer.size + aside) * map.cells.cols() + input, output);
      }
    }
  }
  return sum;
}

void ExpectDefinition(const Convolution& layer, const FeatureMap& map) {
  const FeatureMap out = layer.Run(map);
  ASSERT_EQ(out.side, map.side / layer.stride);
  for (int row = 0; row < out.side; ++row) {
    for (int column = 0; column < out.side; ++column) {
      for (Eigen::Index o = 0; o < layer.bias.size(); ++o) {
        EXPECT_NEAR(out.cells(row * out.side + column, o), OneByOne(layer, map, row, column, o),
                    1e-5)
            << layer.size << " x " << layer.size << ", stride " << layer.stride << ", cell " << row
            << ", " << column;
      }
    }
  }
}

TEST(Convolution, IsItsDefinitionAtBordersAndAtAnyStride) {
  struct Case {
    int size, stride, side;
    Eigen::Index inputs, outputs;
  };
  for (const Case c : {Case{3, 1, 6, 5, 7}, Case{3, 2, 8, 4, 16}, Case{5, 2, 12, 3, 24},
                       Case{1, 1, 4, 9, 3}, Case{1, 2, 6, 2, 5}}) {
    const Convolution layer = RandomLayer(c.size, c.stride, c.inputs, c.outputs);
    EXPECT_EQ(layer.inputs(), c.inputs);
    ExpectDefinition(layer, RandomMap(c.side, c.inputs));
  }
}

// Where windows are alike one result serves them all: nobody, but for one cell, and what lies
// beyond the border, which is not like nobody.
TEST(Convolution, IsItsDefinitionWhereMostCellsAreAlike) {
  for (const int stride : {1, 2}) {
    const Convolution layer = RandomLayer(3, stride, 4, 8);
    FeatureMap map = RandomMap(12, 4);
    map.cells.rowwise() = Eigen::RowVectorXf(map.cells.row(0));
    ExpectDefinition(layer, map);
    map.cells.row(6 * map.side + 7) *= 2.0F;
    ExpectDefinition(layer, map);
  }
}

TEST(Convolution, RectifiesAndDoubles) {
  FeatureMap map{2, RowMatrix(4, 1)};
  map.cells << 1, -2, 3, -4;
  const FeatureMap doubled = Doubled(Rectified(map));
  RowMatrix expected(16, 1);
  expected << 1, 1, 0, 0, 1, 1, 0, 0, 3, 3, 0, 0, 3, 3, 0, 0;
  EXPECT_EQ(doubled.side, 4);
  EXPECT_EQ(doubled.cells, expected);
}

}  // namespace
}  // namespace ossa
