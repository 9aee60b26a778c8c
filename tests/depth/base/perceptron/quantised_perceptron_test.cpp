#include "depth/base/perceptron/quantised_perceptron.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>
#include <vector>

#include "depth/base/perceptron/weight_sums_internal.h"
#include "tests/support/perceptrons.h"

namespace ossa {
namespace {

using test::RandomPerceptron;

// Up to the quantisation of activations to about one in 2^15 of the largest.
void ExpectAboutEqual(const Eigen::RowVectorXf& said, const Eigen::RowVectorXf& wanted) {
  EXPECT_LT((said - wanted).norm(), 1e-4F * (1.0F + wanted.norm()));
}

TEST(QuantisedPerceptron, EqualsThePerceptron) {
  std::srand(7);  // Eigen draws from it
  for (const auto& sizes : {std::vector<Eigen::Index>{11, 3}, {11, 7, 3}, {11, 103, 103, 3}}) {
    const Perceptron perceptron = RandomPerceptron(sizes);
    RowMatrix some = 4.0F * RowMatrix::Random(3, 11);
    some.row(0).head(6).setZero();
    some.row(1).setZero();
    const RowMatrix said = QuantisedPerceptron(perceptron).Run(some);
    ASSERT_EQ(said.rows(), 3);
    for (Eigen::Index r = 0; r < 3; ++r) {
      ExpectAboutEqual(said.row(r), perceptron.Run(some.row(r)));
    }
  }
}

// 103 and 130 units: more than three and four cache lines of weights.
TEST(QuantisedPerceptron, PackedPerceptronsEqualSeparateOnes) {
  std::srand(8);
  const std::vector<Perceptron> perceptrons = {RandomPerceptron({40, 103, 103, 3}),
                                               RandomPerceptron({5, 3}),
                                               RandomPerceptron({40, 130, 3})};
  PerceptronPacker packer(1);  // many fewer than there are
  for (const Perceptron& each : perceptrons) packer.Add(each);
  const std::vector<QuantisedPerceptron> packed = packer.Take();
  ASSERT_EQ(packed.size(), perceptrons.size());
  for (size_t n = 0; n < perceptrons.size(); ++n) {
    const RowMatrix some = RowMatrix::Random(1, perceptrons[n].input_mean.size());
    const RowMatrix said = packed[n].Run(some);
    ExpectAboutEqual(said.row(0), perceptrons[n].Run(some).row(0));
    EXPECT_EQ(said, QuantisedPerceptron(perceptrons[n]).Run(some)) << n;
  }
}

// Twice as many inputs as can be at their maximum with one sign: without limits the sum would
// overflow.
TEST(QuantisedPerceptron, SumsOfLargeInputsDoNotOverflow) {
  constexpr Eigen::Index kInputs = 1100;
  Perceptron perceptron = test::SilentPerceptron({kInputs, 1});
  perceptron.layers[0].weight = RoundToBytes(RowMatrix::Ones(kInputs, 1)).ToWeights();
  for (const float each : {5.0F, -5.0F}) {
    const RowMatrix loud = RowMatrix::Constant(1, kInputs, each);
    ExpectAboutEqual(QuantisedPerceptron(perceptron).Run(loud).row(0), perceptron.Run(loud).row(0));
  }
}

// An input a thousandth as large as another still counts.
TEST(QuantisedPerceptron, SmallInputsCountBesideALargeOne) {
  Perceptron perceptron = test::SilentPerceptron({2, 2});
  perceptron.layers[0].weight = RoundToBytes(RowMatrix::Identity(2, 2)).ToWeights();
  const Eigen::RowVector2f some(4.0F, 0.004F);
  const RowMatrix said = QuantisedPerceptron(perceptron).Run(some), wanted = perceptron.Run(some);
  EXPECT_NEAR(said(0, 0), wanted(0, 0), 1e-4F);
  EXPECT_NEAR(said(0, 1), wanted(0, 1), 1e-4F);
  EXPECT_GT(wanted(0, 1), 3e-3F);
}

template <size_t kExamples>
void ExpectTheSameSums() {
  std::mt19937 draw(5);
  std::uniform_int_distribution<int> weight(-127, 127), factor(-16000, 16000);
  constexpr size_t kPairs = 37, kBlocks = 3;
  std::vector<WeightLine> lines(kBlocks * kPairs);
  for (WeightLine& line : lines) {
    for (auto& [first, second] : line.weights) {
      first = static_cast<int8_t>(weight(draw));
      second = static_cast<int8_t>(weight(draw));
    }
  }
  std::vector<PairFactors<kExamples>> factors(kPairs);
  for (PairFactors<kExamples>& pair : factors) {
    for (auto& [first, second] : pair) {
      first = static_cast<int16_t>(factor(draw));
      second = static_cast<int16_t>(factor(draw));
    }
  }
  const auto sums_by = [&](auto add) {
    std::array<std::vector<int32_t>, kExamples> sums;
    WeightSums<kExamples> of{.factors = factors, .lines = lines.data(), .blocks = kBlocks};
    for (size_t c = 0; c < kExamples; ++c) {
      sums[c].assign(kBlocks * WeightLine::kUnits, -1);
      of.sums[c] = sums[c].data();
    }
    add(of);
    return sums;
  };
  const auto sums = sums_by([](const auto& of) { AddWeights(of); });
  EXPECT_EQ(sums, sums_by([](const auto& of) { AddWeightsOneByOne(of); }));
  constexpr size_t kUnit = WeightLine::kUnits + 9;  // in the second block
  int32_t wanted = 0;
  for (size_t pair = 0; pair < kPairs; ++pair) {
    for (size_t i = 0; i < 2; ++i) {
      wanted += lines[kPairs + pair].weights[9][i] * factors[pair].back()[i];
    }
  }
  EXPECT_EQ(sums.back()[kUnit], wanted);
}

TEST(WeightSums, EqualSumsOneByOne) {
  ExpectTheSameSums<1>();
  ExpectTheSameSums<2>();
}

}  // namespace
}  // namespace ossa
