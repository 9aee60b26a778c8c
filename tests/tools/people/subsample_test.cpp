#include "tools/people/subsample.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace ossa::people {
namespace {

depth::DepthFrame Numbered(int width, int height) {
  depth::DepthFrame frame;
  frame.camera = {.width = width, .height = height, .fx = 60, .fy = 62, .cx = 3.5, .cy = 2.5};
  frame.depth_mm.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
  std::iota(frame.depth_mm.begin(), frame.depth_mm.end(), uint16_t{1000});
  return frame;
}

TEST(Subsample, KeepsEverySecondPixelOfEverySecondRow) {
  const depth::DepthFrame frame = Numbered(7, 5);  // odd: the last ones count, too
  std::vector<int32_t> all(frame.pixel_count());
  std::iota(all.begin(), all.end(), 0);
  const Subsampled small = Subsample(frame, all, 2);
  EXPECT_EQ(small.frame.camera.width, 4);
  EXPECT_EQ(small.frame.camera.height, 3);
  ASSERT_EQ(small.pixels.size(), 12U);
  ASSERT_EQ(small.frame.depth_mm.size(), 12U);
  for (int v = 0; v < 3; ++v) {
    for (int u = 0; u < 4; ++u) {
      EXPECT_EQ(small.frame.depth_mm[static_cast<size_t>(4 * v + u)],
                frame.depth_mm[static_cast<size_t>(7 * 2 * v + 2 * u)]);
    }
  }
}

TEST(Subsample, PointsStayInPlace) {
  const depth::DepthFrame frame = Numbered(8, 6);
  const Subsampled small = Subsample(frame, std::vector<int32_t>{4 * 8 + 6}, 2);
  ASSERT_EQ(small.pixels, (std::vector<int32_t>{2 * 4 + 3}));
  const uint16_t mm = frame.depth_mm[4 * 8 + 6];
  EXPECT_TRUE(depth::BackProject(small.frame.camera, 3, 2, mm)
                  .isApprox(depth::BackProject(frame.camera, 6, 4, mm), 1e-9));
}

TEST(Subsample, PixelsOfOthersBecomeNoReading) {
  const depth::DepthFrame frame = Numbered(8, 6);
  const Subsampled small = Subsample(frame, std::vector<int32_t>{0, 1, 8, 2 * 8 + 2, 3 * 8 + 3}, 2);
  EXPECT_EQ(small.pixels, (std::vector<int32_t>{0, 4 + 1}));
  EXPECT_EQ(std::count(small.frame.depth_mm.begin(), small.frame.depth_mm.end(), 0), 12 - 2);
}

}  // namespace
}  // namespace ossa::people
