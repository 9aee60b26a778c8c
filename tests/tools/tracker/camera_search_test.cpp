#include "tools/tracker/camera_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

constexpr double kRatio = 1.44;  // of a RealSense's colour camera's f to its depth camera's

depth::Camera WithFocal(depth::Camera camera, double ratio) {
  camera.fx *= ratio;
  camera.fy *= ratio;
  return camera;
}

// The capsule person is slim: as large as forests have never seen one only when tall, too.
tests::CapsulePose TallPerson() {
  tests::CapsulePose person = PersonAt(0.0, 2.6);
  person.height_m = 2.1;
  return person;
}

class CameraSearchTest : public testing::Test {
 protected:
  size_t Search(const std::vector<depth::Camera>& cameras) const {
    CameraSearch search(cameras, PlainOptions());
    search.AddImage(frame_);
    return search.Best();
  }

  const depth::DepthFrame frame_ = Rendered({TallPerson()}).frame;
  const depth::Camera right_ = frame_.camera;
};

TEST_F(CameraSearchTest, PrefersTheNarrowerCameraIfTheFirstMakesPeopleTooLarge) {
  OSSA_NEEDS_MODEL();
  EXPECT_EQ(Search({WithFocal(right_, 1.0 / kRatio), right_}), 1u);
}

TEST_F(CameraSearchTest, KeepsTheFirstCameraIfOthersMakePeopleTooSmall) {
  OSSA_NEEDS_MODEL();
  EXPECT_EQ(Search({right_, WithFocal(right_, kRatio)}), 0u);
}

TEST_F(CameraSearchTest, DecidesFromPeopleOnly) {
  OSSA_NEEDS_MODEL();
  CameraSearch search({right_, WithFocal(right_, kRatio)}, PlainOptions());
  depth::DepthFrame empty = frame_;
  std::fill(empty.depth_mm.begin(), empty.depth_mm.end(), uint16_t{0});
  for (int i = 0; i < 8; ++i) search.AddImage(empty);
  EXPECT_FALSE(search.is_sure());
  EXPECT_EQ(search.Best(), 0u);
  for (int i = 0; i < 8; ++i) search.AddImage(frame_);
  EXPECT_TRUE(search.is_sure());
}

}  // namespace
}  // namespace ossa::tracker
