#include "depth/base/angles.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

TEST(Angles, AreConvertedBetweenDegreesAndRadians) {
  EXPECT_DOUBLE_EQ(180.0 * kDegree, std::numbers::pi);
  EXPECT_DOUBLE_EQ(ToDegrees(std::numbers::pi / 2.0), 90.0);
  EXPECT_DOUBLE_EQ(ToDegrees(-37.5 * kDegree), -37.5);
}

}  // namespace
}  // namespace ossa
