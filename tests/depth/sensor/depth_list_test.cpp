#include "depth/sensor/depth_list.h"

#include <gtest/gtest.h>

namespace ossa::depth {
namespace {

TEST(DepthList, IsSecondsAndFilesInOrderOfTime) {
  const DepthList list = ParseDepthList(
      "# depth maps\n# timestamp filename\n1305031102.260407 depth/b.png\r\n"
      "1305031102.160407 depth/a.png\n\n");
  ASSERT_EQ(list.entries.size(), 2u);
  EXPECT_EQ(list.entries[0].file, "depth/a.png");
  EXPECT_EQ(list.entries[0].time_s, 0.0);
  EXPECT_NEAR(list.entries[1].time_s, 0.1, 1e-6);
  EXPECT_TRUE(list.bad_lines.empty());
}

TEST(DepthList, LinesThatAreNoneAreNumbered) {
  const DepthList list = ParseDepthList("1 a.png\nhello\nnan b.png\n2x c.png\n3 d.png");
  EXPECT_EQ(list.entries.size(), 2u);
  EXPECT_EQ(list.bad_lines, (std::vector<int>{2, 3, 4}));
}

TEST(DepthList, OtherTextHasNoEntries) {
  EXPECT_TRUE(ParseDepthList("Recorded in the lab.\n").entries.empty());
}

}  // namespace
}  // namespace ossa::depth
