#include "depth/base/perceptron/matrix_product.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace ossa {
namespace {

RowMatrix Filled(Eigen::Index rows, Eigen::Index columns, float first) {
  RowMatrix m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    m.data()[i] = std::sin(first + 0.7F * static_cast<float>(i));
  }
  return m;
}

class MultiplySizes : public testing::TestWithParam<std::array<int, 3>> {};

TEST_P(MultiplySizes, EqualsTheOrderedSumBitByBit) {
  const auto [rows, inner, columns] = GetParam();
  const RowMatrix a = Filled(rows, inner, 0.1F);
  const RowMatrix b = Filled(inner, columns, 2.0F);
  const RowMatrix product = Multiply(a, b);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      volatile float sum = 0.0F;  // volatile: the compiler may not sum in another order
      for (int k = 0; k < inner; ++k) {
        const volatile float term = a(r, k) * b(k, c);
        sum = sum + term;
      }
      EXPECT_EQ(product(r, c), sum) << r << ", " << c;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(MatrixProduct, MultiplySizes,
                         testing::Values(std::array{1, 1, 1}, std::array{1, 40, 16},
                                         std::array{4, 7, 32}, std::array{5, 3, 37},
                                         std::array{9, 64, 15}, std::array{13, 600, 37},
                                         std::array{6, 256, 16}, std::array{8, 0, 20}));

}  // namespace
}  // namespace ossa
