#include "depth/base/perceptron/rounded_perceptron.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "tests/support/perceptrons.h"

namespace ossa {
namespace {

TEST(RoundedPerceptron, EqualsThePerceptron) {
  std::srand(7);  // Eigen draws from it
  for (const auto& sizes : {std::vector<Eigen::Index>{11, 3}, {11, 7, 3}, {11, 103, 80, 3}}) {
    const Perceptron perceptron = test::RandomPerceptron(sizes);
    RowMatrix some = 4.0F * RowMatrix::Random(3, 11);
    some.row(0).head(6).setZero();
    some.row(1).setZero();
    const RowMatrix said = RoundedPerceptron(perceptron).Run(some), wanted = perceptron.Run(some);
    ASSERT_EQ(said.rows(), 3);
    EXPECT_LT((said - wanted).norm(), 2e-3F * (1.0F + wanted.norm()));
  }
}

TEST(RoundedPerceptron, MayBeEmptyAndMayHaveALayerWithoutUnits) {
  EXPECT_TRUE(RoundedPerceptron(Perceptron()).empty());
  Perceptron perceptron = test::SilentPerceptron({4, 0, 2});
  perceptron.layers[1].bias << 1.0F, 2.0F;
  EXPECT_EQ(RoundedPerceptron(perceptron).Run(RowMatrix::Random(1, 4)),
            (RowMatrix(1, 2) << 1.0F, 2.0F).finished());
}

}  // namespace
}  // namespace ossa
