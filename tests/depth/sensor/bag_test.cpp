// ROS 1 bags, written by the library that reads them.
#include <gtest/gtest.h>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/bag_writer.h"
#include "tests/depth/sensor/ros_bytes.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using rosbag::compression::CompressionType;
using test::RawMessage;

void Write(rosbag::Bag& bag, const std::string& topic, uint32_t seconds,
           const RawMessage& message) {
  bag.write(topic, ros::Time(seconds, 0), message);
}

RawMessage ImageOf(uint32_t seconds, uint16_t depth, const std::string& encoding = "16UC1") {
  return {"sensor_msgs/Image",
          test::RosImageBytes(encoding, 4, 2, std::vector<uint16_t>(8, depth), 8, false, seconds)};
}

// Three depth images of two topics and a camera, all of one bag.
void WriteBag(const std::string& path, CompressionType compression) {
  rosbag::Bag bag;
  bag.open(path, rosbag::bagmode::Write);
  bag.setCompression(compression);
  for (uint32_t i = 0; i < 3; ++i) {
    Write(bag, "/camera/depth/image_raw", 100 + i,
          ImageOf(100 + i, static_cast<uint16_t>(1000 + i)));
    Write(bag, "/camera/ir/image_raw", 100 + i, ImageOf(100 + i, 7, "mono16"));
    Write(bag, "/camera/depth/camera_info", 100 + i,
          {"sensor_msgs/CameraInfo", test::RosCameraInfo(366, 1.5)});
  }
  bag.close();
}

std::vector<DepthFrame> FramesOf(FrameSource& source) {
  std::vector<DepthFrame> frames;
  for (;;) {
    ReadResult read = source.Read(std::chrono::milliseconds(1000));
    if (read.status == ReadStatus::kEnd) return frames;
    if (read.status == ReadStatus::kFrame) frames.push_back(std::move(read.frame));
  }
}

class Bags : public testing::TestWithParam<CompressionType> {};

TEST_P(Bags, GiveDepthCameraAndTimes) {
  const test::TemporaryFolder folder;
  WriteBag(folder / "x.bag", GetParam());
  const auto source = OpenSource(folder / "x.bag");
  EXPECT_EQ(source->camera(), (Camera{4, 2, 366, 366, 256, 1.5}));
  EXPECT_EQ(source->frame_count(), 3);
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].depth_mm, std::vector<uint16_t>(8, 1002));
  EXPECT_DOUBLE_EQ(frames[2].time_s - frames[0].time_s, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Compressed, Bags,
                         testing::Values(CompressionType::Uncompressed, CompressionType::BZ2,
                                         CompressionType::LZ4));

TEST(Bag, ItsTopicsAreChosenAfterItsName) {
  const test::TemporaryFolder folder;
  WriteBag(folder / "x.bag", CompressionType::Uncompressed);
  const std::string name = folder / "x.bag";
  EXPECT_TRUE(IsRecording(name + "#/camera/ir/image_raw"));
  EXPECT_EQ(FramesOf(*OpenSource(name + "#/camera/ir/image_raw"))[0].depth_mm[0], 7);
  test::ExpectRefused([&] { OpenSource(name + "#/none"); }, "/camera/depth/image_raw");
}

TEST(Bag, OfTheRealSenseViewerStatesItsUnit) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag", rosbag::bagmode::Write);
  Write(bag, "/device_0/sensor_0/Depth_0/image/data", 100, ImageOf(100, 4000, "mono16"));
  Write(bag, "/device_0/sensor_0/option/Depth_Units/value", 100,
        {"std_msgs/Float32", test::RosBytes().Add(0.00025F).bytes});
  bag.close();
  EXPECT_EQ(FramesOf(*OpenSource(folder / "x.bag"))[0].depth_mm[0], 1000);
}

TEST(Bag, WithoutDepthNamesItsTopics) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag", rosbag::bagmode::Write);
  Write(bag, "/rgb", 100, ImageOf(100, 7, "bgr8"));
  bag.close();
  test::ExpectRefused([&] { OpenSource(folder / "x.bag"); }, "found /rgb");
}

}  // namespace
}  // namespace ossa::depth
