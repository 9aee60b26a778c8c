// Images of image_transport's plugins, and messages of camera makers.
#include "depth/sensor/readers/ros/bag_image.h"

#include <gtest/gtest.h>

#include "depth/image/png_codec_internal.h"
#include "depth/sensor/readers/ros/maker_messages.h"
#include "tests/depth/sensor/ros_bytes.h"
#include "tests/support/refused.h"

namespace ossa::depth {
namespace {

using test::RosBytes;

constexpr auto kCdr = RosWire::kCdr;
const BagTopic kPacked{"/depth/compressedDepth", "sensor_msgs/CompressedImage", kCdr};

std::vector<uint8_t> PngOf(const std::vector<uint16_t>& samples, int width, int height) {
  return EncodeGreyPng(reinterpret_cast<const uint8_t*>(samples.data()), {width, height},
                       sizeof(uint16_t) * static_cast<size_t>(width), 16);
}

std::vector<uint8_t> MessageOf(const std::string& format, std::span<const uint8_t> data) {
  return RosBytes(kCdr).AddHeader(100, 250'000'000).AddText(format).AddSequence(data).bytes;
}

// compressedDepth's header, then an image.
std::vector<uint8_t> DepthMessageOf(const std::string& format, std::span<const uint8_t> image,
                                    float a = 0.0F, float b = 0.0F) {
  RosBytes data;
  data.Add(uint32_t{1}).Add(a).Add(b);
  data.bytes.insert(data.bytes.end(), image.begin(), image.end());
  return MessageOf(format, data.bytes);
}

std::vector<uint16_t> DepthsOf(const std::vector<uint8_t>& message) {
  return DecodeDepths(ReadBagImage(kPacked, message).image, 0.0);
}

TEST(CompressedDepth, IsAPng) {
  const std::vector<uint16_t> depths = {1000, 2000, 0, 65535, 1, 2};
  for (const char* format : {"16UC1; compressedDepth png", "16UC1; compressedDepth"}) {
    const auto message = DepthMessageOf(format, PngOf(depths, 3, 2));
    const BagImage read = ReadBagImage(kPacked, message);
    EXPECT_EQ(read.image.width, 3u);
    EXPECT_EQ(read.image.height, 2u);
    EXPECT_DOUBLE_EQ(read.image.time_s, 100.25);
    EXPECT_EQ(DecodeDepths(read.image, 0.0), depths);
    EXPECT_EQ(DecodeDepths(read.image, 0.0001), (std::vector<uint16_t>{100, 200, 0, 6554, 0, 0}));
  }
  EXPECT_EQ(DepthsOf(MessageOf("16UC1; png compressed ", PngOf(depths, 3, 2))), depths);
}

// depth = a / (value - b), metres.
TEST(CompressedDepth, OfMetresIsQuantisedByItsInverse) {
  const auto png = PngOf({0, 5000, 2500, 1}, 4, 1);
  EXPECT_EQ(DepthsOf(DepthMessageOf("32FC1; compressedDepth png", png, 10'000.0F, 0.0F)),
            (std::vector<uint16_t>{0, 2000, 4000, 0}));
}

// 0 0 1000 1010 995 0: two without a reading, then three of +1000, +10, -15; then one and none.
TEST(CompressedDepth, IsRvl) {
  RosBytes image;
  image.Add(uint32_t{6}).Add(uint32_t{1});
  // 2 | 3 | 2000 = 0b011'111'010'000 | 20 = 0b010'100 | 29 = 0b011'101, low bits first, 8: goes on
  image.Add(uint32_t{0x238AF3C2}).Add(uint32_t{0xD3100000});
  const auto message = DepthMessageOf("16UC1; compressedDepth rvl", image.bytes);
  EXPECT_EQ(DepthsOf(message), (std::vector<uint16_t>{0, 0, 1000, 1010, 995, 0}));
}

TEST(CompressedDepth, RefusesDamage) {
  const auto whole = DepthMessageOf("16UC1; compressedDepth png", PngOf({1, 2, 3, 4}, 2, 2));
  for (size_t size = 0; size < whole.size(); ++size) {
    EXPECT_THROW(ReadBagImage(kPacked, std::span(whole).first(size)), InputError) << size;
  }
  RosBytes image;
  image.Add(uint32_t{6}).Add(uint32_t{1}).Add(uint32_t{0x77000000});  // 7 empty ones of 6
  test::ExpectRefused(
      [&] { ReadBagImage(kPacked, DepthMessageOf("16UC1; compressedDepth rvl", image.bytes)); },
      "found runs of others");
  RosBytes endless;
  endless.Add(uint32_t{6}).Add(uint32_t{1}).Add(uint32_t{0xFFFFFFFF}).Add(uint32_t{0xFFFFFFFF});
  test::ExpectRefused(
      [&] { ReadBagImage(kPacked, DepthMessageOf("16UC1; compressedDepth rvl", endless.bytes)); },
      "more than 32 bits");
  RosBytes large;
  large.Add(uint32_t{1} << 20).Add(uint32_t{1} << 20);
  test::ExpectRefused(
      [&] { ReadBagImage(kPacked, DepthMessageOf("16UC1; compressedDepth rvl", large.bytes)); },
      "found 1048576x1048576");
}

TEST(CompressedImage, OfColoursIsNoDepth) {
  for (const char* format : {"jpeg", "bgr8; jpeg compressed bgr8", "16UC1; jpeg compressed "}) {
    const BagImage read = ReadBagImage(kPacked, MessageOf(format, PngOf({1}, 1, 1)));
    EXPECT_EQ(ParseDepthEncoding(read.image), RosDepth::kNone) << format;
  }
}

TEST(RosFields, ReadsBothByteOrdersOfCdr) {
  const std::vector<uint8_t> big = {0, 0, 0, 0, 7, 0, 0, 0, 0x12, 0x34, 0x56, 0x78};
  RosFields fields(big, kCdr);
  EXPECT_EQ(fields.Value<uint8_t>(), 7);
  EXPECT_EQ(fields.Value<uint32_t>(), 0x12345678u);
  const std::vector<uint8_t> little = {0, 1, 0, 0, 7, 0, 0, 0, 0x78, 0x56, 0x34, 0x12};
  RosFields other(little, kCdr);
  EXPECT_EQ(other.Value<uint8_t>(), 7);
  EXPECT_EQ(other.Value<uint32_t>(), 0x12345678u);
}

TEST(RosFields, AlignsEightBytesToFourInSecondVersionOfCdr) {
  const std::vector<uint8_t> message = {0, 7, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0};
  RosFields fields(message, kCdr);
  EXPECT_EQ(fields.Value<uint32_t>(), 1u);
  EXPECT_EQ(fields.Value<uint64_t>(), 2u);
  const std::vector<uint8_t> lists = {0, 3, 0, 0};
  test::ExpectRefused([&] { RosFields(lists, kCdr); }, "found encapsulation 3");
}

TEST(RosFields, RefusesASequenceThatIsLongerThanTheMessage) {
  const auto message = RosBytes().Add(uint32_t{0xFFFFFFFF}).bytes;
  test::ExpectRefused([&] { RosFields(message, RosWire::kRos1).Sequence<double>(); }, "more bytes");
}

TEST(RealSenseIntrinsics, AreReadFromText) {
  const RosCameraInfo info = ParseRealSenseIntrinsics(
      "width=640;height=480;fx=383.25;ppx=321.5;fy=383.5;ppy=241;model=Inverse Brown Conrady;"
      "coeffs=0.1,-0.2,0.001,0,0.05");
  EXPECT_EQ(CameraOf(info, false, 640, 480), (Camera{640, 480, 383.25, 383.5, 321.5, 241}));
  EXPECT_EQ(info.d, (std::vector<double>{0.1, -0.2, 0.001, 0, 0.05}));
  EXPECT_FALSE(LensOf(info, KinectV1Camera(640, 480))) << "it maps the other way";
  EXPECT_FALSE(CameraOf(ParseRealSenseIntrinsics("no=1;;=;fx"), false, 640, 480));
}

TEST(RealSenseUnit, IsATextOrANumber) {
  const auto text = RosBytes(kCdr).AddText("0.000100").bytes;
  EXPECT_DOUBLE_EQ(ReadDepthUnit({"/u", "std_msgs/String", kCdr}, text), 0.0001);
  const auto number = RosBytes().Add(0.001F).bytes;
  EXPECT_FLOAT_EQ(
      static_cast<float>(ReadDepthUnit({"/u", "std_msgs/Float32", RosWire::kRos1}, number)),
      0.001F);
  const auto other = RosBytes(kCdr).AddText("none").bytes;
  EXPECT_EQ(ReadDepthUnit({"/u", "std_msgs/String", kCdr}, other), 0.0);
}

}  // namespace
}  // namespace ossa::depth
