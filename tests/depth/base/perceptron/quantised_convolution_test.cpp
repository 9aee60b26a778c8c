#include "depth/base/perceptron/quantised_convolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "depth/base/perceptron/window_sums_internal.h"

namespace ossa {
namespace {

FeatureMap RandomMap(int side, Eigen::Index channels) {
  return {side, RowMatrix::Random(static_cast<Eigen::Index>(side) * side, channels)};
}

Convolution RandomLayer(int size, int stride, Eigen::Index inputs, Eigen::Index outputs) {
  return {size, stride, RowMatrix::Random(size * size * inputs, outputs),
          Eigen::RowVectorXf::Random(outputs)};
}

// The definition, as a scalar loop.
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

// Up to the quantisation of features to one in 2^12 of the largest, and of weights with similar
// resolution.
void ExpectDefinition(const Convolution& layer, const FeatureMap& map) {
  constexpr float kRounding = 5e-4F;  // of numbers up to 1, each of two
  const float most = kRounding * std::sqrt(static_cast<float>(layer.weight.rows())) *
                     std::max(1.0F, map.cells.cwiseAbs().maxCoeff());
  const FeatureMap out = QuantisedConvolution(layer).Run(map);
  ASSERT_EQ(out.side, map.side / layer.stride);
  for (int row = 0; row < out.side; ++row) {
    for (int column = 0; column < out.side; ++column) {
      for (Eigen::Index o = 0; o < layer.bias.size(); ++o) {
        EXPECT_NEAR(out.cells(row * out.side + column, o), OneByOne(layer, map, row, column, o),
                    most)
            << layer.size << " x " << layer.size << ", stride " << layer.stride << ", cell " << row
            << ", " << column;
      }
    }
  }
}

TEST(QuantisedConvolution, EqualsTheDefinitionAtBordersAndForAnyStride) {
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

// Equal windows share one result: an empty map except for one cell, and the padding, which differs
// from empty cells.
TEST(QuantisedConvolution, EqualsTheDefinitionForUniformMaps) {
  for (const int stride : {1, 2}) {
    const Convolution layer = RandomLayer(3, stride, 4, 8);
    FeatureMap map = RandomMap(12, 4);
    map.cells.rowwise() = Eigen::RowVectorXf(map.cells.row(0));
    ExpectDefinition(layer, map);
    map.cells.row(6 * map.side + 7) *= 2.0F;
    ExpectDefinition(layer, map);
  }
}

// The largest possible sums: with one bit less they would overflow.
TEST(QuantisedConvolution, SumsOfLargeFeaturesDoNotOverflow) {
  constexpr Eigen::Index kInputs = 4000;
  const Convolution layer{1, 1, RowMatrix::Ones(kInputs, 1), Eigen::RowVectorXf::Zero(1)};
  for (const float each : {5.0F, -5.0F}) {
    const FeatureMap loud{1, RowMatrix::Constant(1, kInputs, each)};
    // All weights are rounded the same way, by up to half of one in 131.
    EXPECT_NEAR(QuantisedConvolution(layer).Run(loud).cells(0, 0), kInputs * each,
                kInputs * 5.0F / 260.0F);
  }
}

TEST(QuantisedConvolution, ZeroMapGivesTheBias) {
  const Convolution layer = RandomLayer(3, 1, 2, 5);
  const FeatureMap out = QuantisedConvolution(layer).Run({4, RowMatrix::Zero(16, 2)});
  for (Eigen::Index cell = 0; cell < 16; ++cell) EXPECT_EQ(out.cells.row(cell), layer.bias);
  Convolution silent = layer;
  silent.weight.setZero();
  EXPECT_EQ(QuantisedConvolution(silent).Run(RandomMap(4, 2)).cells.row(3), layer.bias);
}

TEST(QuantisedConvolution, PropagatesNonFiniteFeatures) {
  const QuantisedConvolution layer(RandomLayer(3, 1, 2, 5));
  for (const float odd :
       {std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(),
        std::numeric_limits<float>::quiet_NaN()}) {
    FeatureMap map = RandomMap(4, 2);
    map.cells(7, 1) = odd;
    EXPECT_FALSE(layer.Run(map).cells.row(15).allFinite()) << odd;
  }
}

// One to thirteen windows: all remainders of the six and two windows that are summed together.
TEST(WindowSums, EqualSumsOneByOne) {
  std::mt19937 draw(5);
  std::uniform_int_distribution<int> number(-4000, 4000);
  const auto drawn = [&] { return static_cast<int16_t>(number(draw)); };
  constexpr size_t kRows = 3, kPairs = 7, kStride = 40, kOutputs = OutputLine::kOutputs;
  std::vector<int16_t> map(kStride * kStride);
  for (int16_t& of : map) of = drawn();
  std::vector<OutputLine> lines(kRows * kPairs);
  for (OutputLine& line : lines) {
    for (auto& [first, second] : line.weights) first = drawn(), second = drawn();
  }
  for (size_t count = 1; count <= 30; ++count) {
    std::vector<const int16_t*> first;
    for (size_t w = 0; w < count; ++w) first.push_back(map.data() + w % 4 * kStride + 2 * w);
    const Windows windows{first, kRows, kPairs, kStride};
    std::vector<int32_t> sums(2 * kOutputs * count, 7);
    const std::vector<int32_t> untouched = sums;
    SumWindows(windows, lines.data(), sums.data(), 2 * kOutputs);
    for (const WindowSums way : ListWindowSums()) {
      std::vector<int32_t> same = untouched;
      way(windows, lines.data(), same.data(), 2 * kOutputs);
      EXPECT_EQ(sums, same) << count;
    }
    int32_t wanted = 0;
    for (size_t k = 0; k < 2 * kRows * kPairs; ++k) {
      const size_t row = k / (2 * kPairs), along = k % (2 * kPairs);
      wanted += lines[k / 2].weights[9][k % 2] * first.back()[row * kStride + along];
    }
    EXPECT_EQ(sums[2 * kOutputs * (count - 1) + 9], wanted);
  }
}

}  // namespace
}  // namespace ossa
