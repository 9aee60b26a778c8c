#include "depth/base/perceptron/convolution.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

TEST(FeatureMap, RectifiesAndDoubles) {
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
