#include "depth/sensor/readers/ros/ros_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "depth/sensor/readers/ros/bag_topics.h"
#include "tests/depth/sensor/ros_bytes.h"
#include "tests/support/refused.h"

namespace ossa::depth {
namespace {

using test::RosCameraInfoBytes;
using test::RosImageBytes;

TEST(RosImage, ReadsRowsOfDepths) {
  const auto bytes =
      RosImageBytes("16UC1", 2, 2, {1, 2, 0xEE, 3, 4, 0xEE}, 6);  // a pixel of padding
  const RosImage image = ParseRosImage(bytes);
  EXPECT_DOUBLE_EQ(image.time_s, 100.25);
  EXPECT_EQ(ParseDepthEncoding(image), RosDepth::k16Bits);
  EXPECT_EQ(DecodeDepths(image, 0), (std::vector<uint16_t>{1, 2, 3, 4}));
  EXPECT_EQ(DecodeDepths(image, 0.01), (std::vector<uint16_t>{10, 20, 30, 40}));
}

TEST(RosImage, SwapsBytesOfTheOtherOrder) {
  const auto bytes = RosImageBytes("mono16", 2, 1, {0x0100, 0x0002}, 4, true);
  EXPECT_EQ(DecodeDepths(ParseRosImage(bytes), 0), (std::vector<uint16_t>{1, 0x0200}));
}

TEST(RosImage, ConvertsMetresToMillimetresAndNanToNoReading) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto bytes = RosImageBytes("32FC1", 4, 1, std::vector<float>{1.5F, nan, -1.0F, 100.0F}, 16);
  EXPECT_EQ(DecodeDepths(ParseRosImage(bytes), 0), (std::vector<uint16_t>{1500, 0, 0, 0}));
}

TEST(RosImage, RefusesEveryTruncation) {
  const auto bytes = RosImageBytes("16UC1", 2, 1, {1, 2}, 4);
  for (size_t size = 0; size < bytes.size(); ++size) {
    test::ExpectRefused([&] { ParseRosImage(std::span(bytes).first(size)); }, "more bytes");
  }
}

TEST(RosImage, RefusesMorePixelsThanBytes) {
  const auto bytes = RosImageBytes("16UC1", 2, 3, {1, 2}, 4);
  test::ExpectRefused([&] { DecodeDepths(ParseRosImage(bytes), 0); }, "2x3");
}

TEST(RosCameraInfo, GivesTheCameraOfImagesOfItsSize) {
  const RosCameraInfo info = ParseRosCameraInfo(RosCameraInfoBytes(512, 424, 366));
  EXPECT_EQ(CameraOf(info, false, 512, 424), (Camera{512, 424, 366, 366, 256, 212}));
}

TEST(RosCameraInfo, IsScaledToImagesOfItsAspectRatio) {
  const RosCameraInfo info = ParseRosCameraInfo(RosCameraInfoBytes(640, 480, 570));
  EXPECT_EQ(CameraOf(info, false, 320, 240), (Camera{320, 240, 285, 285, 160, 120}));
}

TEST(RosCameraInfo, GivesNoCameraForAnotherAspectRatioOrWithoutCalibration) {
  EXPECT_FALSE(CameraOf(ParseRosCameraInfo(RosCameraInfoBytes(1920, 1080, 1400)), false, 640, 480));
  EXPECT_FALSE(CameraOf(ParseRosCameraInfo(RosCameraInfoBytes(640, 480, 0)), false, 640, 480));
}

TEST(RosCameraInfo, RegionOfInterestShiftsTheCamera) {
  const RosCameraInfo info = ParseRosCameraInfo(RosCameraInfoBytes({.width = 640,
                                                                    .height = 480,
                                                                    .f = 570,
                                                                    .left = 200,
                                                                    .top = 100,
                                                                    .region_width = 320,
                                                                    .region_height = 240}));
  EXPECT_EQ(CameraOf(info, false, 320, 240), (Camera{320, 240, 570, 570, 120, 140}));
  EXPECT_EQ(CameraOf(info, false, 160, 120), (Camera{160, 120, 285, 285, 60, 70}));  // binned
  EXPECT_EQ(CameraOf(info, false, 640, 480), (Camera{640, 480, 570, 570, 320, 240}));
}

TEST(RosCameraInfo, RectifiedImagesUseTheProjectionMatrix) {
  const RosCameraInfo info = ParseRosCameraInfo(
      RosCameraInfoBytes({.width = 640, .height = 480, .f = 585, .rectified_f = 577}));
  EXPECT_EQ(CameraOf(info, true, 640, 480)->fx, 577);
  EXPECT_EQ(CameraOf(info, false, 640, 480)->fx, 585);
  const RosCameraInfo plain = ParseRosCameraInfo(RosCameraInfoBytes(640, 480, 585));
  EXPECT_EQ(CameraOf(plain, true, 640, 480)->fx, 585);
}

RosCameraInfo InfoWithLens(const std::string& model, const std::vector<double>& d) {
  return ParseRosCameraInfo(
      RosCameraInfoBytes({.width = 640, .height = 480, .f = 500, .lens_model = model, .lens = d}));
}

TEST(RosCameraInfo, HasDistortionInOpenCvsOrder) {
  const std::vector<double> d = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8};
  const auto lens = LensOf(InfoWithLens("rational_polynomial", d), KinectV1Camera(640, 480));
  ASSERT_TRUE(lens);
  EXPECT_EQ((std::vector<double>{lens->k1, lens->k2, lens->p1, lens->p2, lens->k3, lens->k4,
                                 lens->k5, lens->k6}),
            d);
  EXPECT_EQ(LensOf(InfoWithLens("plumb_bob", d), KinectV1Camera(640, 480))->k4, 0.0);
  EXPECT_EQ(LensOf(InfoWithLens("plumb_bob", {0.1, 0.2, 0.3, 0.4}), {})->k3, 0.0);
}

TEST(RosCameraInfo, IgnoresZeroDistortionAndOtherModels) {
  EXPECT_FALSE(LensOf(InfoWithLens("plumb_bob", {0.0, 0.0, 0.0, 0.0, 0.0}), {}));
  EXPECT_FALSE(LensOf(InfoWithLens("", {}), {}));
  EXPECT_FALSE(LensOf(InfoWithLens("equidistant", {0.1, 0.0, 0.0, 0.0}), {}));
  EXPECT_TRUE(HasLens(InfoWithLens("equidistant", {0.1, 0.0, 0.0, 0.0})));
  EXPECT_FALSE(LensOf(InfoWithLens("plumb_bob", {std::nan("")}), {}));
}

// r (1 - 0.3 r^2) is largest where its slope 1 - 0.9 r^2 is 0.
TEST(LensCamera, EndsWhereTheDistortionIsNoLongerMonotonic) {
  EXPECT_NEAR(ComputeFoldingRadius({.pinhole = {}, .k1 = -0.3}), 1.054, 0.011);
  EXPECT_GT(ComputeFoldingRadius({.pinhole = {}, .k1 = 0.3}), 3.0);
}

TEST(RosTopic, RectifiedImagesAreRecognisedByTheLastWord) {
  for (const char* topic : {"/camera/depth/image_rect", "/a/image_rect_raw", "rect"}) {
    EXPECT_TRUE(IsRectified(topic)) << topic;
  }
  for (const char* topic : {"/camera/depth/image_raw", "/direct/image", "/rect/image", "/a_", ""}) {
    EXPECT_FALSE(IsRectified(topic)) << topic;
  }
}

const std::vector<BagTopic> kRealSense = {
    {"/device_0/sensor_0/Depth_0/image/data", "sensor_msgs/Image"},
    {"/device_0/sensor_0/Depth_0/info/camera_info", "sensor_msgs/CameraInfo"},
    {"/device_0/sensor_1/Color_0/info/camera_info", "sensor_msgs/CameraInfo"},
    {"/device_0/sensor_0/option/Depth_Units/value", "std_msgs/Float32"}};

TEST(BagTopics, RecognisesTopicsOfTheRealSenseViewer) {
  const BagChoice choice = ChooseDepthTopic({kRealSense[0].name}, kRealSense, "");
  EXPECT_EQ(choice.image, kRealSense[0].name);
  EXPECT_EQ(choice.camera_info, kRealSense[1].name);
  EXPECT_EQ(choice.unit, kRealSense[3].name);
  EXPECT_TRUE(choice.notes.empty());
}

TEST(BagTopics, PrefersATopicNamedDepthAndListsTheOthers) {
  const BagChoice choice = ChooseDepthTopic({"/ir", "/camera/depth/image", "/b/depth"}, {}, "");
  EXPECT_EQ(choice.image, "/b/depth");
  ASSERT_EQ(choice.notes.size(), 1u);
  EXPECT_NE(choice.notes[0].find("/camera/depth/image"), std::string::npos) << choice.notes[0];
  EXPECT_EQ(ChooseDepthTopic({"/ir", "/b/depth"}, {}, "/ir").image, "/ir");
}

// The camera_info of a bag with these that is taken for the image's; notes only of one not its own.
struct Infos {
  const char* image;
  std::vector<const char*> infos;
  const char* taken;
  bool noted = false;
};

class CameraInfoTopics : public testing::TestWithParam<Infos> {};

TEST_P(CameraInfoTopics, PreferTheImagesOwnNamespace) {
  std::vector<BagTopic> topics;
  for (const char* info : GetParam().infos) topics.push_back({info, "sensor_msgs/CameraInfo"});
  const BagChoice choice = ChooseDepthTopic({GetParam().image}, topics, "");
  EXPECT_EQ(choice.camera_info, GetParam().taken);
  EXPECT_EQ(choice.notes.size(), GetParam().noted ? 1u : 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Bags, CameraInfoTopics,
    testing::Values(
        Infos{"/camera/depth/image_raw",
              {"/camera/depth_registered/camera_info", "/camera/depth/camera_info"},
              "/camera/depth/camera_info"},
        Infos{"/camera/depth/image_raw",
              {"/camera/rgb/camera_info"},
              "/camera/rgb/camera_info",
              true},
        Infos{"/camera1/depth/image", {"/camera2/depth/camera_info", "/camera_info"}, ""},
        Infos{"/depth_image", {"/camera_info", "/depth_2/camera_info"}, "/camera_info"}));

TEST(BagTopics, RefusesAMissingTopicAndListsTheExistingOnes) {
  test::ExpectRefused([] { ChooseDepthTopic({"/depth"}, {}, "/x"); }, "(/depth)");
  test::ExpectRefused([] { ChooseDepthTopic({}, {{"/scan", "x"}}, ""); }, "found /scan");
}

}  // namespace
}  // namespace ossa::depth
