#include "depth/sensor/clock_names.h"

#include <gtest/gtest.h>

#include "depth/sensor/frame_names.h"

namespace ossa::depth {
namespace {

using Names = std::vector<std::string>;

struct ClockCase {
  const char* what;
  Names names;
};

class ClocksInNames : public testing::TestWithParam<ClockCase> {};

// Each across the end of an hour or second, 0.1 s apart and then 0.3.
TEST_P(ClocksInNames, AreTimes) {
  const NamedTimes times = ReadTimesFromNames(GetParam().names);
  ASSERT_EQ(times.kind, NamedTimes::Kind::kTimes);
  ASSERT_EQ(times.times_s.size(), 3u);
  EXPECT_NEAR(times.times_s[1], 0.1, 1e-6);
  EXPECT_NEAR(times.times_s[2], 0.4, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    EachForm, ClocksInNames,
    testing::Values(
        ClockCase{
            "Date",
            {"2024-05-01_12-59-59-900", "2024-05-01_13-00-00-000", "2024-05-01_13-00-00-300"}},
        ClockCase{"DateInOneNumber",
                  {"20241231235959900", "20250101000000000", "20250101000000300"}},
        ClockCase{"DateAndCount",
                  {"depth_0001_20240501T125959.900000_x", "depth_0002_20240501T130000.000000_x",
                   "depth_0003_20240501T130000.300000_x"}},
        ClockCase{"Day", {"12-59-59-900", "13-00-00-000", "13-00-00-300"}},
        ClockCase{"SecondsAndNanoseconds",
                  {"1714568398_900000000", "1714568399_0", "1714568399_300000000"}},
        ClockCase{"CountAndMilliseconds",
                  {"000017_1714568398900", "000018_1714568399000", "000021_1714568399300"}},
        ClockCase{"MillisecondsWithAFraction",
                  {"1714568398900.25", "1714568399000.25", "1714568399300.25"}}),
    [](const auto& info) { return std::string(info.param.what); });

// A date that all share, and a count: no camera has such steps.
TEST(ClockNames, ThatOnlyCountAreNone) {
  for (const Names& names :
       {Names{"20240501_120000_001", "20240501_120000_002", "20240501_120000_003"},
        Names{"20240501_000001", "20240501_000002", "20240501_000003"},
        Names{"1714568398_000001", "1714568398_000002", "1714568398_000003"},
        Names{"2024-05-01_12-00-00-900_1", "2024-05-01_12-00-00-900_2"}, Names{"a", "b"},
        Names{}}) {
    EXPECT_FALSE(ReadTimesFromClocks(names)) << (names.empty() ? "" : names[0]);
  }
}

}  // namespace
}  // namespace ossa::depth
