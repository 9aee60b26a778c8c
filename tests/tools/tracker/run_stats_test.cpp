#include "tools/tracker/run_stats.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace ossa::tracker {
namespace {

// A camera runs for days: 48 bytes a frame were 5 MB an hour.
static_assert(std::is_trivially_copyable_v<RunStats>, "it owns no memory that could grow");

TEST(TimeHistogram, QuantilesAreAccurateToHalfABin) {
  TimeHistogram ms;
  for (int i = 1; i <= 1000; ++i) ms.Add(0.01 * i);  // 0.01 to 10 ms
  EXPECT_NEAR(ms.Quantile(0.5), 5.005, 0.005 * 5.005);
  EXPECT_NEAR(ms.Quantile(0.99), 9.90, 0.005 * 9.90 + 0.01);  // a bin, and a step of the values
  EXPECT_EQ(ms.count(), 1000);
  EXPECT_NEAR(ms.sum_ms(), 5005.0, 1e-6);
}

TEST(TimeHistogram, EmptyHistogramGivesZero) {
  EXPECT_EQ(TimeHistogram().Quantile(0.5), 0.0);
  TimeHistogram idle;  // a stage that does not run
  idle.Add(0.0);
  EXPECT_EQ(idle.Quantile(0.99), 0.0);
}

TEST(TimeHistogram, HoursCountInTheLastBin) {
  TimeHistogram ms;
  ms.Add(1.0);
  ms.Add(1e9);
  EXPECT_GT(ms.Quantile(1.0), 100e3);
}

}  // namespace
}  // namespace ossa::tracker
