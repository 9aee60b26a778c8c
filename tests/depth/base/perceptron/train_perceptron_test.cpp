#include "depth/base/perceptron/train_perceptron.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ossa {
namespace {

// y = |x| of three numbers at once: no line says that.
PerceptronExamples Bends() {
  constexpr Eigen::Index kRows = 4 * kPerceptronBatch;
  PerceptronExamples examples{RowMatrix(kRows, 1), RowMatrix(kRows, 3)};
  for (Eigen::Index i = 0; i < kRows; ++i) {
    const float x = 2.0F * static_cast<float>(i) / static_cast<float>(kRows) - 1.0F;
    examples.input(i, 0) = 50.0F + 10.0F * x;
    for (Eigen::Index k = 0; k < 3; ++k) examples.wanted(i, k) = std::abs(x);
  }
  return examples;
}

TEST(TrainPerceptron, TwoHiddenLayersFitANonlinearFunction) {
  PerceptronExamples examples = Bends();
  PerceptronTraining options;
  options.hidden = {32, 16};
  options.outputs = 3;
  options.epochs = 200;
  const auto network = TrainPerceptron(&examples, PointDistanceGradient(0.01F), options);
  ASSERT_EQ(network.layers.size(), 3U);
  EXPECT_EQ(network.layers[1].weight.rows(), 32);
  EXPECT_EQ(network.layers[1].weight.cols(), 16);
  for (const float x : {-0.9F, -0.4F, 0.4F, 0.9F}) {
    const RowMatrix said = network.Run(RowMatrix::Constant(1, 1, 50.0F + 10.0F * x));
    for (Eigen::Index k = 0; k < 3; ++k) EXPECT_NEAR(said(0, k), std::abs(x), 0.1F) << x;
  }
}

TEST(TrainPerceptron, UnknownTargetsHaveNoGradient) {
  const auto gradient = PointDistanceGradient(0.01F);
  RowMatrix out = RowMatrix::Zero(2, 6), wanted = out;
  wanted(0, 1) = std::numeric_limits<float>::quiet_NaN();
  wanted(1, 3) = 2.0F;
  const RowMatrix found = gradient(out, wanted);
  EXPECT_TRUE((found.row(0).array() == 0.0F).all());
  EXPECT_NEAR(found(1, 3), -0.5F, 1e-4F);  // of length 1, over two rows
  EXPECT_EQ(found(1, 0), 0.0F);
}

}  // namespace
}  // namespace ossa
