#include "depth/base/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ossa {
namespace {

TEST(Median, IsTheMiddleOneOrTheUpperOfTwo) {
  EXPECT_EQ(Median<double>({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(Median<double>({4.0, 1.0, 2.0, 3.0}), 3.0);
  EXPECT_EQ(Median<int>({7}), 7);
}

TEST(Median, OfNoValuesIsNan) {
  EXPECT_TRUE(std::isnan(MedianOrNan({})));
  EXPECT_EQ(MedianOrNan({3.0, 1.0, 2.0}), 2.0);
}

TEST(SelectRank, EqualsTheElementOfTheSortedValues) {
  const std::vector<int> values = {5, 3, 9, 1, 7};
  for (size_t rank = 0; rank < values.size(); ++rank) {
    std::vector<int> some = values;
    EXPECT_EQ(SelectRank(some, rank), 1 + 2 * static_cast<int>(rank));
  }
}

}  // namespace
}  // namespace ossa
