#include "depth/sensor/depth_list.h"

#include <gtest/gtest.h>

namespace ossa::depth {
namespace {

TEST(DepthList, IsSortedByTimeInSeconds) {
  const DepthList list = ParseDepthList(
      "# depth maps\n# timestamp filename\n1305031102.260407 depth/b.png\r\n"
      "1305031102.160407 depth/a.png\n\n");
  ASSERT_EQ(list.entries.size(), 2u);
  EXPECT_EQ(list.entries[0].file, "depth/a.png");
  EXPECT_EQ(list.entries[0].time_s, 0.0);
  EXPECT_NEAR(list.entries[1].time_s, 0.1, 1e-6);
  EXPECT_TRUE(list.bad_lines.empty());
}

TEST(DepthList, ConvertsTimesToSeconds) {
  const std::vector<std::pair<const char*, double>> lists = {
      {"10.5 a\n10.6 b\n12.5 c", 1.0},
      {"7 a\n8 b\n9 c", 1.0},  // a frame a second
      {"1305031102175 a\n1305031102275 b\n1305031104175 c", 1e-3},
      {"0 a\n33.333 b\n2000 c", 1e-3},
      {"1305031102175304 a\n1305031102275304 b\n1305031102375304 d\n1305031104175304 c", 1e-6},
      {"1305031102175304000 a\n1305031102208637000 b\n1305031104175304000 c", 1e-9}};
  for (const auto& [text, unit_s] : lists) {
    const DepthList list = ParseDepthList(text);
    EXPECT_EQ(list.unit_s, unit_s) << text;
    EXPECT_NEAR(list.entries.back().time_s, 2.0, 1e-6) << text;
  }
}

TEST(DepthList, ReportsMalformedLinesByNumber) {
  const DepthList list = ParseDepthList("1 a.png\nhello\nnan b.png\n2x c.png\n3 d.png");
  EXPECT_EQ(list.entries.size(), 2u);
  EXPECT_EQ(list.bad_lines, (std::vector<int>{2, 3, 4}));
}

TEST(DepthList, LinesWithImpossibleTimesAreMalformed) {
  const DepthList list = ParseDepthList("1 a\n1e300 b\n2 c\ninf d");
  EXPECT_EQ(list.entries.size(), 2u);
  EXPECT_EQ(list.bad_lines, (std::vector<int>{2, 4}));
}

TEST(DepthList, IgnoresAByteOrderMark) {
  const DepthList list = ParseDepthList(
      "\xEF\xBB\xBF"
      "1.5 a.png\n2.5 b.png\n");
  EXPECT_EQ(list.entries.size(), 2u);
  EXPECT_TRUE(list.bad_lines.empty());
}

TEST(DepthList, OtherTextHasNoEntries) {
  EXPECT_TRUE(ParseDepthList("Recorded in the lab.\n").entries.empty());
}

}  // namespace
}  // namespace ossa::depth
