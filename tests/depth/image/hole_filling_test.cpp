#include "depth/image/hole_filling.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "depth/base/random.h"

namespace ossa::depth {
namespace {

constexpr int kWidth = 120, kHeight = 90;
constexpr uint16_t kNear_mm = 1500, kFar_mm = 3200;

// A flat object in front of a wall.
DepthFrame NearBeforeFar() {
  DepthFrame frame;
  frame.camera = {kWidth, kHeight, 100, 100, 60, 45};
  frame.time_s = 1.5;
  frame.index = 7;
  frame.depth_mm.assign(static_cast<size_t>(kWidth) * kHeight, kFar_mm);
  for (int v = 20; v < 80; ++v) {
    for (int u = 40; u < 90; ++u) frame.depth_mm[static_cast<size_t>(v * kWidth + u)] = kNear_mm;
  }
  return frame;
}

DepthFrame WithHoles(DepthFrame frame, double share) {
  Random random(3);
  for (uint16_t& z_mm : frame.depth_mm) {
    if (random.Uniform(0.0, 1.0) < share) z_mm = 0;
  }
  return frame;
}

int64_t CountHoles(const DepthFrame& frame) {
  return std::count(frame.depth_mm.begin(), frame.depth_mm.end(), 0);
}

TEST(FillScatteredHoles, KeepsImagesWithAsFewHolesAsAStructuredLightSensor) {
  EXPECT_FALSE(FillScatteredHoles(NearBeforeFar()));
  EXPECT_FALSE(FillScatteredHoles(WithHoles(NearBeforeFar(), 0.01)));
}

TEST(FillScatteredHoles, FillsWithReadingsOfOneSideOrTheOther) {
  const DepthFrame whole = NearBeforeFar();
  const auto filled = FillScatteredHoles(WithHoles(whole, 0.3));
  ASSERT_TRUE(filled);
  EXPECT_LT(CountHoles(*filled), 0.01 * kWidth * kHeight);
  int wrong = 0;
  for (size_t i = 0; i < whole.depth_mm.size(); ++i) {
    const uint16_t z_mm = filled->depth_mm[i];
    ASSERT_TRUE(z_mm == 0 || z_mm == kNear_mm || z_mm == kFar_mm) << "pixel " << i;
    wrong += z_mm != 0 && z_mm != whole.depth_mm[i] ? 1 : 0;
  }
  EXPECT_LT(wrong, 100);  // of the silhouette's 440 pixels on either side of its border
}

TEST(FillScatteredHoles, KeepsReadingsTimeAndCamera) {
  const DepthFrame holed = WithHoles(NearBeforeFar(), 0.2);
  const auto filled = FillScatteredHoles(holed);
  ASSERT_TRUE(filled);
  EXPECT_EQ(filled->camera, holed.camera);
  EXPECT_EQ(filled->time_s, holed.time_s);
  EXPECT_EQ(filled->index, holed.index);
  for (size_t i = 0; i < holed.depth_mm.size(); ++i) {
    if (holed.depth_mm[i] == 0) continue;
    ASSERT_EQ(filled->depth_mm[i], holed.depth_mm[i]) << "pixel " << i;
  }
}

TEST(FillScatteredHoles, KeepsShadowsAndCutOutRegions) {
  DepthFrame frame = NearBeforeFar();
  for (uint16_t& z_mm : frame.depth_mm) z_mm = z_mm == kFar_mm ? 0 : z_mm;
  const auto filled = FillScatteredHoles(WithHoles(frame, 0.2));
  ASSERT_TRUE(filled);
  for (size_t i = 0; i < frame.depth_mm.size(); ++i) {
    if (frame.depth_mm[i] != 0) continue;
    ASSERT_EQ(filled->depth_mm[i], 0) << "pixel " << i;
  }
}

// Depth registered to a larger image without interpolation.
TEST(FillScatteredHoles, FillsMissingRowsAndColumns) {
  for (const int every : {2, 3, 4, 5}) {
    for (const bool columns_too : {false, true}) {
      DepthFrame striped = NearBeforeFar();
      for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
          const bool is_missing = v % every == 1 || (columns_too && u % every == 1);
          if (is_missing) striped.depth_mm[static_cast<size_t>(v * kWidth + u)] = 0;
        }
      }
      const auto filled = FillScatteredHoles(striped);
      ASSERT_TRUE(filled) << every;
      EXPECT_LE(CountHoles(*filled), 2 * (kWidth + kHeight)) << every;  // at the image's border
    }
  }
}

TEST(FillScatteredHoles, ReadsOnlyTheViewOfALargerImage) {
  const DepthFrame holed = WithHoles(NearBeforeFar(), 0.2);
  const int stride = kWidth + 9;
  std::vector<uint16_t> buffer(static_cast<size_t>(stride) * kHeight, 555);
  for (int v = 0; v < kHeight; ++v) {
    std::copy_n(&holed.depth_mm[static_cast<size_t>(v * kWidth)], kWidth,
                &buffer[static_cast<size_t>(v * stride + 4)]);
  }
  DepthFrame part = holed;
  part.depth_mm.clear();
  part.borrowed = {&buffer[4], kWidth, kHeight, stride};
  const auto expected = FillScatteredHoles(holed), filled = FillScatteredHoles(part);
  ASSERT_TRUE(expected && filled);
  EXPECT_EQ(filled->depth_mm, expected->depth_mm);
}

TEST(FillScatteredHoles, AcceptsImagesOfAnySize) {
  for (const int width : {1, 2, 3}) {
    for (const int height : {1, 2, 3}) {
      DepthFrame frame;
      frame.camera = {width, height, 10, 10, 0, 0};
      frame.depth_mm.assign(static_cast<size_t>(width * height), 1000);
      frame.depth_mm.back() = 0;
      EXPECT_FALSE(FillScatteredHoles(frame)) << width << "x" << height;
    }
  }
}

}  // namespace
}  // namespace ossa::depth
