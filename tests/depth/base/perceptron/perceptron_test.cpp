#include "depth/base/perceptron/perceptron.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "depth/base/perceptron/perceptron_file.h"
#include "tests/support/perceptrons.h"

namespace ossa {
namespace {

TEST(WeightBytes, QuantisingTwiceEqualsOnce) {
  std::srand(3);
  RowMatrix weight = RowMatrix::Random(30, 40);
  weight.row(4) *= 1e-3F;
  weight.row(5).setZero();
  const WeightBytes once = RoundToBytes(weight), twice = RoundToBytes(once.ToWeights());
  EXPECT_EQ(once.bytes, twice.bytes);
  EXPECT_EQ(once.step, twice.step);
  EXPECT_EQ(once.bytes.row(4).cast<int>().cwiseAbs().maxCoeff(), 127);
  for (Eigen::Index i = 0; i < weight.rows(); ++i) {
    const float error = (once.ToWeights().row(i) - weight.row(i)).cwiseAbs().maxCoeff();
    EXPECT_LE(error, 0.51F * once.step[i]) << i;
  }
}

TEST(Perceptron, RectifiesAllLayersExceptTheLast) {
  Perceptron perceptron = test::SilentPerceptron({1, 2, 1, 1});
  perceptron.input_mean << 1.0F;
  perceptron.input_scale << 2.0F;
  perceptron.layers[0].weight << 1.0F, -1.0F;
  perceptron.layers[1].weight << 1.0F, -3.0F;
  perceptron.layers[1].bias << 0.5F;
  perceptron.layers[2].weight << -1.0F;
  const auto said = [&](float x) { return perceptron.Run(RowMatrix::Constant(1, 1, x))(0, 0); };
  EXPECT_FLOAT_EQ(said(2.0F), -2.5F);  // 2 -> (2, 0) -> 2.5 -> -2.5
  EXPECT_FLOAT_EQ(said(0.0F), 0.0F);   // -2 -> (0, 2) -> rectified
  EXPECT_FLOAT_EQ(said(1e6F), -5.5F);  // no more than five standard deviations count
}

// Results for an example must not depend on the others in its batch.
TEST(Perceptron, BatchEqualsSingleRows) {
  std::srand(5);
  const Perceptron perceptron = test::RandomPerceptron({40, 70, 9});
  const RowMatrix inputs = RowMatrix::Random(8, 40);
  const RowMatrix together = perceptron.Run(inputs);
  for (Eigen::Index r = 0; r < inputs.rows(); ++r) {
    EXPECT_EQ(together.row(r), perceptron.Run(inputs.row(r)).row(0)) << r;
  }
}

}  // namespace
}  // namespace ossa
