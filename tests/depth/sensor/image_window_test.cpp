#include "depth/sensor/image_window_internal.h"

#include <gtest/gtest.h>

namespace ossa::depth {
namespace {

TEST(ImageWindow, ScalingTheWholeImageScalesTheCamera) {
  EXPECT_EQ(CropToWindow(KinectV1Camera(640, 480), {320, 240, 0, 0, 320, 240}),
            KinectV1Camera(320, 240));
}

TEST(ImageWindow, CroppingKeepsTheFocalLength) {
  EXPECT_EQ(CropToWindow(KinectV1Camera(640, 480), {640, 480, 320, 100, 160, 120}),
            (Camera{160, 120, 575, 575, 0, 140}));
  const Camera stated{0, 0, 525, 526, 319.5, 239.5};  // --camera is of the whole image, too
  EXPECT_EQ(CropToWindow(stated, {640, 480, 320, 240, 320, 240}),
            (Camera{320, 240, 525, 526, -0.5, -0.5}));
}

TEST(ImageWindow, LiesInsideTheImage) {
  EXPECT_TRUE((ImageWindow{640, 480, 0, 0, 640, 480}).IsSane());
  EXPECT_TRUE((ImageWindow{640, 480, 639, 479, 1, 1}).IsSane());
  for (const ImageWindow& wrong : {ImageWindow{},
                                   {9000, 480, 0, 0, 1, 1},
                                   {640, -1, 0, 0, 1, 1},
                                   {640, 480, -1, 0, 9, 9},
                                   {640, 480, 0, 480, 1, 1},
                                   {640, 480, 320, 0, 321, 240},
                                   {640, 480, 0, 1, 640, 480},
                                   {640, 480, 0, 0, 0, 240},
                                   {640, 480, 9, 9, 2147483647, 9}}) {
    EXPECT_FALSE(wrong.IsSane()) << wrong.left << " " << wrong.width;
  }
}

}  // namespace
}  // namespace ossa::depth
