#include "depth/base/angles.h"

#include <gtest/gtest.h>

namespace ossa {
namespace {

TEST(Angles, AreTurnedIntoRadiansAndBack) {
  EXPECT_DOUBLE_EQ(ToRadians(180.0), std::numbers::pi);
  EXPECT_DOUBLE_EQ(ToDegrees(std::numbers::pi / 2.0), 90.0);
  EXPECT_DOUBLE_EQ(ToDegrees(ToRadians(-37.5)), -37.5);
}

}  // namespace
}  // namespace ossa
