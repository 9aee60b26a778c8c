#include "depth/image/camera_presets.h"

#include <gtest/gtest.h>

#include <tuple>

#include "depth/base/error.h"
#include "depth/image/camera_io.h"

namespace ossa::depth {
namespace {

struct Size {
  int width, height;
  const char* preset;
  double f_px;
};

class ImageSizes : public testing::TestWithParam<Size> {};

TEST_P(ImageSizes, DetermineTheCamera) {
  const auto [width, height, preset, f_px] = GetParam();
  const CameraGuess guess = GuessCamera(width, height);
  EXPECT_EQ(guess.preset, preset);
  EXPECT_TRUE(guess.sizes_match);
  EXPECT_NEAR(guess.camera.fx, f_px, 0.5);
  EXPECT_NEAR(guess.camera.fy, f_px, 0.5);
  EXPECT_EQ(guess.camera.width, width);
}

INSTANTIATE_TEST_SUITE_P(
    Known, ImageSizes,
    testing::Values(Size{640, 480, "kinect-v1", 575}, Size{320, 240, "kinect-v1", 287.5},
                    Size{512, 424, "kinect-v2", 366}, Size{640, 576, "azure-nfov", 504},
                    Size{320, 288, "azure-nfov", 252}, Size{1024, 1024, "azure-wfov", 504},
                    Size{512, 512, "azure-wfov", 252}, Size{1280, 720, "d435", 640},
                    Size{848, 480, "d435", 424}, Size{1920, 1080, "kinect-v2-color", 1081.4},
                    Size{960, 540, "kinect-v2-color", 540.7}, Size{2048, 1536, "azure-color", 977},
                    Size{3840, 2160, "azure-color", 1832}));

TEST(ImageSizes, PortraitSizesAreACameraOnItsSide) {
  const CameraGuess guess = GuessCamera(424, 512);
  EXPECT_EQ(guess.preset, "kinect-v2");
  EXPECT_EQ(guess.camera, (Camera{424, 512, 366, 366, 212, 256}));
}

TEST(ImageSizes, UnknownSizesAreAKinectV1s) {
  const CameraGuess guess = GuessCamera(100, 100);
  EXPECT_FALSE(guess.sizes_match);
  EXPECT_EQ(guess.camera, KinectV1Camera(100, 100));
}

TEST(CameraPreset, NamedEqualsGuessed) {
  for (const int width : {60, 80, 100, 240, 320, 424, 480, 512, 576, 640, 848, 1024, 1280}) {
    for (const int height : {60, 80, 100, 240, 320, 424, 480, 512, 576, 640, 848, 1024, 1280}) {
      const CameraGuess guess = GuessCamera(width, height);
      EXPECT_EQ(PresetCamera(guess.preset, width, height), guess.camera) << width << "x" << height;
    }
  }
}

TEST(CameraPreset, HasSquarePixelsForAnyAspectRatio) {
  for (const std::string_view name : CameraPresetNames()) {
    for (const auto& [width, height] : {std::pair(100, 100), {480, 640}, {640, 200}}) {
      const Camera camera = PresetCamera(name, width, height);
      EXPECT_DOUBLE_EQ(camera.fx, camera.fy) << name << " " << width << "x" << height;
    }
  }
}

TEST(CameraPreset, PortraitImageIsTheCameraOnItsSide) {
  EXPECT_EQ(PresetCamera("kinect-v1", 480, 640), (Camera{480, 640, 575, 575, 240, 320}));
  EXPECT_EQ(PresetCamera("xtion", 480, 640).fx, PresetCamera("xtion", 640, 480).fx);
}

TEST(CameraPreset, EveryNameGivesACameraOfTheRequestedSize) {
  for (const std::string_view name : CameraPresetNames()) {
    const Camera camera = CameraForSize(ParseCamera(std::string(name)), 640, 480);
    EXPECT_TRUE(IsSane(camera)) << name;
    EXPECT_EQ(camera.width, 640) << name;
  }
}

// What rs-enumerate-devices prints of a D455.
TEST(CameraPreset, RealSenseCropsToTheAspectRatio) {
  EXPECT_NEAR(PresetCamera("d455", 640, 480).fx, 384, 1);
  EXPECT_NEAR(PresetCamera("d455", 480, 270).fx, 240, 1);
}

// What rs-enumerate-devices prints of a D435's colour camera, to which its users align the depth.
TEST(CameraPreset, RealSenseColourCameraCropsItsSides) {
  for (const auto& [width, height, f_px] :
       {std::tuple(1280, 720, 918.6), {640, 480, 612.4}, {640, 360, 459.3}, {320, 240, 306.2}}) {
    EXPECT_NEAR(PresetCamera("d435-color", width, height).fx / f_px, 1.0, 0.005);
  }
}

TEST(NarrowerCameras, AreColourCamerasAndCrops) {
  ASSERT_EQ(NarrowerCameras(1280, 720).size(), 1u);
  EXPECT_EQ(NarrowerCameras(1280, 720)[0].camera, PresetCamera("d435-color", 1280, 720));
  EXPECT_EQ(NarrowerCameras(1920, 1080).size(), 1u);
  ASSERT_EQ(NarrowerCameras(100, 100).size(), 1u);
  EXPECT_NEAR(NarrowerCameras(100, 100)[0].camera.fx, 119.8, 0.1);
  // As wide as the guess's, or of no other camera.
  for (const auto& [width, height] :
       {std::pair(640, 480), {512, 424}, {640, 576}, {1024, 1024}, {480, 360}, {1280, 800}}) {
    EXPECT_TRUE(NarrowerCameras(width, height).empty()) << width << "x" << height;
  }
}

// OpenNI's own figure for depth that it registered.
TEST(CameraPreset, AlignedToTheColourCameraHasItsFieldOfView) {
  EXPECT_EQ(PresetCamera("kinect-v1-color", 320, 240).fx, 262.5);
}

// The middle of the sensor is not that of the narrow view.
TEST(CameraPreset, AzureNarrowViewIsAboveTheSensorsCentre) {
  const Camera camera = PresetCamera("azure-nfov", 640, 576);
  EXPECT_DOUBLE_EQ(camera.cx, 319.5);
  EXPECT_DOUBLE_EQ(camera.cy, 331.5);
}

TEST(CameraPreset, SquareImageOfAFemtoIsTheWideView) {
  EXPECT_EQ(PresetCamera("femto", 512, 512), PresetCamera("azure-wfov", 512, 512));
  EXPECT_EQ(PresetCamera("femto", 640, 576), PresetCamera("azure-nfov", 640, 576));
}

}  // namespace
}  // namespace ossa::depth
