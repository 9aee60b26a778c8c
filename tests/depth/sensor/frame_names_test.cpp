#include "depth/sensor/frame_names.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ossa::depth {
namespace {

using Kind = NamedTimes::Kind;

TEST(NaturalOrder, NumbersCompareAsNumbers) {
  EXPECT_TRUE(NaturalLess("img_2", "img_10"));
  EXPECT_TRUE(NaturalLess("img_9", "img_0010"));
  EXPECT_TRUE(NaturalLess("a", "b"));
  EXPECT_TRUE(NaturalLess("a99999999999999999999", "a100000000000000000000"));
  EXPECT_FALSE(NaturalLess("img_10", "img_2"));
  EXPECT_FALSE(NaturalLess("img_2", "img_2"));
}

TEST(NaturalOrder, OrdersEqualNumbersConsistently) {
  EXPECT_NE(NaturalLess("01", "1"), NaturalLess("1", "01"));
}

TEST(StripNumbers, RemovesDigits) {
  EXPECT_EQ(StripNumbers("Depth_0012"), "depth_");
  EXPECT_EQ(StripNumbers("frame-000001.depth"), "frame-.depth");
  EXPECT_EQ(StripNumbers("1305031102.175304"), "");
}

struct Case {
  const char* what;
  std::vector<std::string> names;
  Kind kind;
  double last_s;
};

class NamesOfFrames : public testing::TestWithParam<Case> {};

TEST_P(NamesOfFrames, AreReadAsTimesNumbersOrNeither) {
  const NamedTimes times = ReadTimesFromNames(GetParam().names);
  EXPECT_EQ(times.kind, GetParam().kind);
  if (times.kind == Kind::kTimes) {
    EXPECT_NEAR(times.times_s.back(), GetParam().last_s, 1e-6);
    EXPECT_EQ(*std::min_element(times.times_s.begin(), times.times_s.end()), 0.0);
  }
}

// A 10 Hz clip with a gap of 2 s, with the clocks of various recorders.
INSTANTIATE_TEST_SUITE_P(
    AllClocks, NamesOfFrames,
    testing::Values(
        Case{"seconds",
             {"1305031102.175304", "1305031102.275304", "1305031104.275304"},
             Kind::kTimes,
             2.1},
        Case{"a date and a time of day",
             {"frame_20121214T142259.900000_depth", "frame_20121214T142300.000000_depth",
              "frame_20121214T150001.000000_depth"},
             Kind::kTimes,
             37 * 60 + 1.1},
        Case{"milliseconds since 1970",
             {"1305031102175", "1305031102275", "1305031104275"},
             Kind::kTimes,
             2.1},
        Case{
            "milliseconds", {"depth_0", "depth_100", "depth_200", "depth_2200"}, Kind::kTimes, 2.2},
        Case{"microseconds since 1970",
             {"1305031102175304", "1305031102275304", "1305031102375304", "1305031104375304"},
             Kind::kTimes,
             2.2},
        Case{"microseconds", {"000000", "100000", "200000"}, Kind::kTimes, 0.2},
        Case{"nanoseconds since 1970",
             {"1305031102175304000", "1305031102275304000"},
             Kind::kTimes,
             0.1},
        Case{"seconds without the last zeros",
             {"0.0", "0.1", "0.033", "0.067"},
             Kind::kTimes,
             0.067},
        Case{"frame numbers of ten digits", {"0000000001", "0000000002"}, Kind::kNumbers, 0},
        Case{"frame numbers of a version",
             {"depth_v01.0001", "depth_v01.0002", "depth_v01.0003", "depth_v01.0005"},
             Kind::kNumbers,
             0},
        Case{"frame numbers of a second camera", {"cam2.01", "cam2.02"}, Kind::kNumbers, 0},
        Case{"frame numbers of a camera without a word", {"1.0001", "1.0002"}, Kind::kNumbers, 0},
        Case{"a shot and a frame", {"1.0001", "1.0002", "1.0003", "2.0001"}, Kind::kPlaces, 0},
        Case{"a version that counts on", {"take1.9", "take1.10", "take2.1"}, Kind::kPlaces, 0},
        Case{"frame numbers", {"000003", "000004", "000007"}, Kind::kNumbers, 0},
        Case{"every third frame", {"0003", "0006", "0009"}, Kind::kNumbers, 0},
        Case{"every hundredth frame that says so",
             {"frame_00100_depth", "frame_00200_depth", "frame_00300_depth"},
             Kind::kNumbers,
             0},
        Case{"every hundredth frame of a data set",
             {"000000", "000100", "000200", "000400"},
             Kind::kNumbers,
             0},
        Case{"milliseconds with zeros before them",
             {"000033", "000067", "000100"},
             Kind::kTimes,
             0.067},
        Case{"every twentieth frame", {"0", "20", "40", "100"}, Kind::kNumbers, 0},
        Case{"milliseconds at 50 Hz, as clocks have them",
             {"0", "20", "41", "60"},
             Kind::kTimes,
             0.06},
        Case{"milliseconds at 30 Hz without fractions",
             {"0", "33", "66", "99"},
             Kind::kTimes,
             0.099},
        Case{"one in 3 s, in milliseconds", {"003000", "006000", "009000"}, Kind::kPlaces, 0},
        Case{"frame numbers after a word",
             {"img_9", "img_10", "img_12", "img_13"},
             Kind::kNumbers,
             0},
        Case{"a device's ticks", {"depth-1028894671", "depth-1038901490"}, Kind::kPlaces, 0},
        Case{"too large a number", {"1", "99999999999999999999"}, Kind::kPlaces, 0},
        Case{"one number twice", {"1", "01"}, Kind::kPlaces, 0},
        Case{"different words", {"a1", "b2"}, Kind::kPlaces, 0},
        Case{"no numbers", {"a", "b"}, Kind::kPlaces, 0}, Case{"none", {}, Kind::kPlaces, 0}),
    [](const auto& info) {
      std::string name = info.param.what;
      std::erase_if(name, [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); });
      return name;
    });

}  // namespace
}  // namespace ossa::depth
