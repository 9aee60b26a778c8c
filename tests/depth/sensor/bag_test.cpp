// ROS 1 bags, written by the library that reads them.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/bag_writer.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/depth/sensor/ros_bytes.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using rosbag::compression::CompressionType;
using test::FramesOf;
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
          {"sensor_msgs/CameraInfo", test::RosCameraInfoBytes(4, 2, 366)});
  }
  bag.close();
}

class Bags : public testing::TestWithParam<CompressionType> {};

TEST_P(Bags, ContainDepthCameraAndTimes) {
  const test::TemporaryFolder folder;
  WriteBag(folder / "x.bag", GetParam());
  const auto source = OpenSource(folder / "x.bag");
  EXPECT_EQ(source->camera(), (Camera{4, 2, 366, 366, 2, 1}));
  EXPECT_EQ(source->frame_count(), 3);
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[2].depth_mm, std::vector<uint16_t>(8, 1002));
  EXPECT_DOUBLE_EQ(frames[2].time_s - frames[0].time_s, 2.0);
}

INSTANTIATE_TEST_SUITE_P(Compressed, Bags,
                         testing::Values(CompressionType::Uncompressed, CompressionType::BZ2,
                                         CompressionType::LZ4));

// A bag of one depth topic and one camera_info of this size.
void WriteBagWithInfo(const std::string& path, uint32_t width, uint32_t height) {
  rosbag::Bag bag;
  bag.open(path, rosbag::bagmode::Write);
  Write(bag, "/camera/depth/image_raw", 100, ImageOf(100, 1000));
  Write(bag, "/camera/depth/camera_info", 100,
        {"sensor_msgs/CameraInfo", test::RosCameraInfoBytes(width, height, 400)});
  bag.close();
}

TEST(Bag, ScalesCameraInfoOfLargerImages) {
  const test::TemporaryFolder folder;
  WriteBagWithInfo(folder / "x.bag", 640, 320);
  EXPECT_EQ(OpenSource(folder / "x.bag")->camera(), (Camera{4, 2, 2.5, 2.5, 2, 1}));
}

TEST(Bag, IgnoresCameraInfoOfAnotherAspectRatioWithANote) {
  const test::TemporaryFolder folder;
  WriteBagWithInfo(folder / "x.bag", 512, 424);
  std::string notes;
  SourceOptions options;
  options.note = [&](NoteKind, const std::string& note) { notes += note + "\n"; };
  EXPECT_EQ(OpenSource(folder / "x.bag", options)->camera(), GuessCamera(4, 2).camera);
  EXPECT_NE(notes.find("camera_info is of 512x424"), std::string::npos) << notes;
}

// An image of column numbers, with a lens that maps r to r (1 - 0.3 r^2).
std::string WriteBagWithLens(const test::TemporaryFolder& folder, const std::string& topic) {
  std::vector<uint16_t> columns;
  for (int i = 0; i < 64 * 48; ++i) columns.push_back(static_cast<uint16_t>(1000 + i % 64));
  rosbag::Bag bag;
  const std::string path = folder / "x.bag";
  bag.open(path, rosbag::bagmode::Write);
  Write(bag, "/camera/depth/" + topic, 100,
        {"sensor_msgs/Image", test::RosImageBytes("16UC1", 64, 48, columns, 128)});
  Write(bag, "/camera/depth/camera_info", 100,
        {"sensor_msgs/CameraInfo",
         test::RosCameraInfoBytes(
             {.width = 64, .height = 48, .f = 50, .lens = {-0.3, 0.0, 0.0, 0.0, 0.0}})});
  bag.close();
  return path;
}

TEST(Bag, UndistortsRawImages) {
  const test::TemporaryFolder folder;
  const auto source = OpenSource(WriteBagWithLens(folder, "image_raw"), {.depth_scale = 1000.0});
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 1u);
  const double x = (60 - 32) / 50.0;
  const double seen_u = 32 + 50 * x * (1 - 0.3 * x * x);
  EXPECT_EQ(frames[0].depth_mm[24 * 64 + 60], 1000 + std::lround(seen_u));
  EXPECT_EQ(frames[0].depth_mm[24 * 64 + 32], 1032);
}

TEST(Bag, DoesNotUndistortRectifiedImages) {
  const test::TemporaryFolder folder;
  const auto frames =
      FramesOf(*OpenSource(WriteBagWithLens(folder, "image_rect"), {.depth_scale = 1000.0}));
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].depth_mm[24 * 64 + 60], 1060);
}

// The leftover of a killed `rosbag record`.
TEST(Bag, NamesTheRepairCommandForActiveBags) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag.active", rosbag::bagmode::Write);
  Write(bag, "/depth", 100, ImageOf(100, 1000));
  std::filesystem::copy_file(folder / "x.bag.active", folder / "killed.bag.active");
  bag.close();
  EXPECT_TRUE(IsRecording(folder / "killed.bag.active"));
  test::ExpectRefused([&] { OpenSource(folder / "killed.bag.active"); }, "'rosbag reindex'");
  EXPECT_EQ(FramesOf(*OpenSource(folder / "x.bag.active")).size(), 1u);
}

TEST(Bag, ReportsTruncation) {
  const test::TemporaryFolder folder;
  WriteBag(folder / "x.bag", CompressionType::Uncompressed);
  const auto size = std::filesystem::file_size(folder / "x.bag");
  std::filesystem::resize_file(folder / "x.bag", size - size / 4);
  test::ExpectRefused([&] { OpenSource(folder / "x.bag"); }, "one that is cut short");
}

std::string Content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Bag, RefusesAFileThatIsNotABag) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "text.bag") << "no bag, a text of some length\n";
  std::ofstream(folder / "empty.bag");
  test::ExpectRefused([&] { OpenSource(folder / "text.bag"); },
                      "which begins with #ROSBAG, found a file");
  test::ExpectRefused([&] { OpenSource(folder / "empty.bag"); }, "found an empty file");
}

TEST(Bag, RefusesLinkedLz4BlocksAndNamesWhatIsSupported) {
  const test::TemporaryFolder folder;
  WriteBag(folder / "x.bag", CompressionType::LZ4);
  std::string bytes = Content(folder / "x.bag");
  // The frame's descriptor after its magic; bit 5: blocks are independent.
  const size_t frame = bytes.find("\x04\x22\x4D\x18");
  ASSERT_NE(frame, bytes.npos);
  bytes[frame + 4] = static_cast<char>(bytes[frame + 4] & ~0x20);
  std::ofstream(folder / "x.bag", std::ios::binary) << bytes;
  test::ExpectRefused([&] { OpenSource(folder / "x.bag"); }, "PyPI's rosbags");
}

TEST(Bag, ReadsFilesWithManyDepthTopics) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag", rosbag::bagmode::Write);
  for (int i = 0; i < 60; ++i) {
    Write(bag, "/rig/of/many/depth/cameras/" + std::to_string(i), 100, ImageOf(100, 1000));
  }
  bag.close();
  EXPECT_EQ(FramesOf(*OpenSource(folder / "x.bag")).size(), 1u);
}

// Frames with these stamps in order of reception, one second apart.
void WriteBagOfStamps(const std::string& path, const std::vector<uint32_t>& stamps) {
  rosbag::Bag bag;
  bag.open(path, rosbag::bagmode::Write);
  for (uint32_t i = 0; i < stamps.size(); ++i) {
    Write(bag, "/depth", 1000 + i, ImageOf(stamps[i], static_cast<uint16_t>(stamps[i])));
  }
  bag.close();
}

TEST(Bag, ReturnsFramesInTimestampOrder) {
  const test::TemporaryFolder folder;
  WriteBagOfStamps(folder / "x.bag", {1001, 1003, 1002, 1004});
  const auto frames = FramesOf(*OpenSource(folder / "x.bag"));
  ASSERT_EQ(frames.size(), 4u);
  for (size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].depth_mm[0], 1001 + i);
}

TEST(Bag, ReturnsTheFramesBeforeADamagedOne) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag", rosbag::bagmode::Write);
  for (uint32_t i = 0; i < 12; ++i) Write(bag, "/depth", 1000 + i, ImageOf(1000 + i, 1000));
  RawMessage cut = ImageOf(1012, 1000);
  cut.bytes.resize(cut.bytes.size() - 1);
  Write(bag, "/depth", 1012, cut);
  bag.close();
  const auto source = OpenSource(folder / "x.bag");
  for (int i = 0; i < 12; ++i) {
    ASSERT_EQ(source->Read(std::chrono::seconds(10)).status, ReadStatus::kFrame) << i;
  }
  test::ExpectRefused([&] { source->Read(std::chrono::seconds(10)); }, "after frame 11");
  EXPECT_EQ(source->Read(std::chrono::seconds(10)).status, ReadStatus::kEnd);
}

// Its time stamps count from 1970.
TEST(Bag, StartsAtOnceWhenPlayedAsALiveCamera) {
  const test::TemporaryFolder folder;
  WriteBagOfStamps(folder / "x.bag", {1'305'031'102, 1'305'031'103});
  const auto source = OpenSource("openni:ossa://" + (folder / "x.bag").string());
  ReadResult read;
  for (int i = 0; i < 100 && read.status != ReadStatus::kFrame; ++i) {
    read = source->Read(std::chrono::milliseconds(100));
  }
  EXPECT_EQ(read.status, ReadStatus::kFrame);
}

TEST(Bag, DropsFramesThatArriveFarTooLateWithANote) {
  const test::TemporaryFolder folder;
  std::vector<uint32_t> stamps;
  for (uint32_t i = 0; i < 20; ++i) stamps.push_back(1001 + i);
  stamps[12] = 1000;
  WriteBagOfStamps(folder / "x.bag", stamps);
  std::string notes;
  SourceOptions options;
  options.note = [&](NoteKind, const std::string& note) { notes += note + "\n"; };
  const auto source = OpenSource(folder / "x.bag", options);
  int64_t frames = 0, dropped = 0;
  for (ReadResult read; read.status != ReadStatus::kEnd;) {
    read = source->Read(std::chrono::milliseconds(1000));
    frames += read.status == ReadStatus::kFrame ? 1 : 0;
    dropped += read.dropped;
  }
  EXPECT_EQ(frames, 19);
  EXPECT_EQ(dropped, 1);
  EXPECT_NE(notes.find("1 frames are left out"), std::string::npos) << notes;
}

TEST(Bag, ContinuesWhenTheClockIsSetBack) {
  const test::TemporaryFolder folder;
  std::vector<uint32_t> stamps;
  for (uint32_t i = 0; i < 20; ++i) stamps.push_back(1001 + i);
  for (uint32_t i = 0; i < 20; ++i) stamps.push_back(501 + i);
  WriteBagOfStamps(folder / "x.bag", stamps);
  const auto frames = FramesOf(*OpenSource(folder / "x.bag"));
  ASSERT_EQ(frames.size(), 32u);  // of the second clock's the first eight are lost
  for (size_t i = 1; i < frames.size(); ++i) EXPECT_EQ(frames[i].time_s - frames[i - 1].time_s, 1);
  EXPECT_EQ(frames.back().depth_mm[0], 520);
}

TEST(Bag, TopicFollowsTheFileName) {
  const test::TemporaryFolder folder;
  WriteBag(folder / "x.bag", CompressionType::Uncompressed);
  const std::string name = folder / "x.bag";
  EXPECT_TRUE(IsRecording(name + "#/camera/ir/image_raw"));
  EXPECT_EQ(FramesOf(*OpenSource(name + "#/camera/ir/image_raw"))[0].depth_mm[0], 7);
  test::ExpectRefused([&] { OpenSource(name + "#/none"); }, "/camera/depth/image_raw");
  std::filesystem::rename(folder / "x.bag", folder / "X.BAG");
  const std::string in_capitals = (folder / "X.BAG").string() + "#/camera/ir/image_raw";
  EXPECT_TRUE(IsRecording(in_capitals));
  EXPECT_EQ(FramesOf(*OpenSource(in_capitals))[0].depth_mm[0], 7);
}

TEST(Bag, ReadsTheDepthUnitOfTheRealSenseViewer) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag", rosbag::bagmode::Write);
  Write(bag, "/device_0/sensor_0/Depth_0/image/data", 100, ImageOf(100, 4000, "mono16"));
  Write(bag, "/device_0/sensor_0/option/Depth_Units/value", 100,
        {"std_msgs/Float32", test::RosBytes().Add(0.00025F).bytes});
  bag.close();
  EXPECT_EQ(FramesOf(*OpenSource(folder / "x.bag"))[0].depth_mm[0], 1000);
}

TEST(Bag, WithoutDepthListsTheTopics) {
  const test::TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / "x.bag", rosbag::bagmode::Write);
  Write(bag, "/rgb", 100, ImageOf(100, 7, "bgr8"));
  bag.close();
  test::ExpectRefused([&] { OpenSource(folder / "x.bag"); }, "found /rgb");
}

}  // namespace
}  // namespace ossa::depth
