// Bags of ROS 2, .db3 and .mcap, and the recordings of camera makers in these formats.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/frames_of.h"
#include "tests/depth/sensor/ros2_writer.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using test::FramesOf;
using test::McapForm;
using test::Ros2Message;
using test::RosBytes;
using test::TemporaryFolder;

constexpr auto kCdr = RosWire::kCdr;

Ros2Message ImageOf(uint32_t seconds, uint16_t depth) {
  return {
      "/camera/depth/image_raw", "sensor_msgs/msg/Image",
      test::RosImageBytes("16UC1", 4, 2, std::vector<uint16_t>(8, depth), 8, false, seconds, kCdr)};
}

// Three depth images, their camera, and what is not read.
std::vector<Ros2Message> SomeMessages() {
  std::vector<Ros2Message> messages;
  for (uint32_t i = 0; i < 3; ++i) {
    messages.push_back({"/log", "std_msgs/msg/String", RosBytes(kCdr).AddText("odd").bytes});
    messages.push_back({"/camera/depth/camera_info", "sensor_msgs/msg/CameraInfo",
                        test::RosCameraInfoBytes({.width = 4, .height = 2, .f = 366.0}, kCdr)});
    messages.push_back(ImageOf(100 + i, static_cast<uint16_t>(1000 + i)));
  }
  return messages;
}

void WriteFile(const std::filesystem::path& path, std::span<const uint8_t> bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

void WriteMcap(const std::filesystem::path& path, const std::vector<Ros2Message>& messages,
               const McapForm& form = {}) {
  WriteFile(path, test::McapWriter(form).Write(messages));
}

void ExpectSomeFrames(const std::string& path) {
  EXPECT_TRUE(IsRecording(path)) << path;
  const auto source = OpenSource(path);
  EXPECT_EQ(source->camera(), (Camera{4, 2, 366, 366, 2, 1})) << path;
  EXPECT_EQ(source->frame_count(), 3) << path;
  const auto frames = FramesOf(*source);
  ASSERT_EQ(frames.size(), 3u) << path;
  EXPECT_EQ(frames[2].depth_mm, std::vector<uint16_t>(8, 1002)) << path;
  EXPECT_DOUBLE_EQ(frames[2].time_s - frames[0].time_s, 2.0) << path;
}

TEST(SqliteBag, ContainsDepthCameraAndTimes) {
  const TemporaryFolder folder;
  test::SqliteWriter(folder / "x.db3").Write(SomeMessages());
  ExpectSomeFrames(folder / "x.db3");
}

TEST(SqliteBag, ReadsMessagesThatAreCompressedOneByOne) {
  const TemporaryFolder folder;
  auto messages = SomeMessages();
  for (Ros2Message& message : messages) message.bytes = test::PackedByZstd(message.bytes);
  test::SqliteWriter(folder / "x.db3").Write(messages);
  ExpectSomeFrames(folder / "x.db3");
}

TEST(SqliteBag, RefusesWhatIsNoBag) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.db3") << std::string(1000, 'x');
  std::ofstream(folder / "empty.db3");
  test::ExpectRefused([&] { OpenSource(folder / "text.db3"); }, "found: file is not a database");
  test::ExpectRefused([&] { OpenSource(folder / "empty.db3"); }, "found: no such table: topics");
}

TEST(SqliteBag, NamesTheRepairCommandForTruncation) {
  const TemporaryFolder folder;
  std::vector<Ros2Message> messages;
  for (uint32_t i = 0; i < 300; ++i) messages.push_back(ImageOf(100 + i, 1000));
  test::SqliteWriter(folder / "x.db3").Write(messages);
  std::filesystem::resize_file(folder / "x.db3", std::filesystem::file_size(folder / "x.db3") / 2);
  test::ExpectRefused([&] { FramesOf(*OpenSource(folder / "x.db3")); }, ".recover");
}

class McapForms : public testing::TestWithParam<McapForm> {};

TEST_P(McapForms, ContainDepthCameraAndTimes) {
  const TemporaryFolder folder;
  WriteMcap(folder / "x.mcap", SomeMessages(), GetParam());
  ExpectSomeFrames(folder / "x.mcap");
}

INSTANTIATE_TEST_SUITE_P(OfAnyWriter, McapForms,
                         testing::Values(McapForm{}, McapForm{.compression = "lz4"},
                                         McapForm{.compression = "zstd"},
                                         McapForm{.has_checksum = false},
                                         McapForm{.has_index = false},
                                         McapForm{.has_chunks = false}));

TEST(McapBag, ThatWasNotClosedIsReadWithAWarning) {
  const TemporaryFolder folder;
  for (const bool has_index : {true, false}) {
    const McapForm form{.has_index = has_index, .is_closed = false};
    auto bytes = test::McapWriter(form).Write(SomeMessages());
    const size_t whole = bytes.size();
    bytes.resize(whole - 100);  // within the last image's chunk
    WriteFile(folder / "x.mcap", bytes);
    std::string warnings;
    SourceOptions options;
    options.note = [&](NoteKind kind, const std::string& note) {
      if (kind == NoteKind::kWarning) warnings += note;
    };
    EXPECT_EQ(FramesOf(*OpenSource(folder / "x.mcap", options)).size(), 2u);
    EXPECT_NE(warnings.find("it was not closed: byte "), std::string::npos) << warnings;
  }
}

TEST(McapBag, ReturnsTheFramesBeforeADamagedChunk) {
  const TemporaryFolder folder;
  for (const bool has_index : {true, false}) {
    auto bytes = test::McapWriter({.has_index = has_index}).Write(SomeMessages());
    bytes[bytes.size() - 200] ^= 0x10;  // within the last image's chunk
    WriteFile(folder / "x.mcap", bytes);
    const auto source = OpenSource(folder / "x.mcap");
    for (int i = 0; i < 2; ++i) {
      ASSERT_EQ(source->Read(std::chrono::seconds(10)).status, ReadStatus::kFrame) << i;
    }
    test::ExpectRefused([&] { source->Read(std::chrono::seconds(10)); }, "found damage");
  }
}

TEST(McapBag, RefusesWhatIsNoMcap) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.mcap") << "a text of some length";
  std::ofstream(folder / "empty.mcap");
  WriteMcap(folder / "xz.mcap", SomeMessages(), {.compression = "xz"});
  test::ExpectRefused([&] { OpenSource(folder / "text.mcap"); }, "one that begins otherwise");
  test::ExpectRefused([&] { OpenSource(folder / "empty.mcap"); }, "an empty one");
  test::ExpectRefused([&] { OpenSource(folder / "xz.mcap"); }, "found 'xz'");
}

TEST(McapBag, WithoutMessagesOfRosHasNoDepth) {
  const TemporaryFolder folder;
  WriteMcap(folder / "x.mcap", SomeMessages(), {.encoding = "protobuf"});
  test::ExpectRefused([&] { OpenSource(folder / "x.mcap"); }, "found none");
}

TEST(Ros2Folder, IsOneBagOfAllItsFilesInOrder) {
  const TemporaryFolder folder;
  std::ofstream(folder / "metadata.yaml") << "rosbag2_bagfile_information:\n";
  for (uint32_t i = 0; i < 11; ++i) {
    test::SqliteWriter(folder / ("bag_" + std::to_string(i) + ".db3"))
        .Write({ImageOf(100 + i, static_cast<uint16_t>(1000 + i))});
  }
  std::ofstream(folder / "._bag_0.db3") << "a resource file of macOS";
  EXPECT_TRUE(IsRecording(folder.path()));
  const std::string name = folder.path().string() + "#/camera/depth/image_raw";
  for (const std::string& source : {folder.path().string(), name}) {
    const auto frames = FramesOf(*OpenSource(source));
    ASSERT_EQ(frames.size(), 11u);
    for (size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].depth_mm[0], 1000 + i);
  }
}

TEST(Ros2Folder, NamesTheFileThatIsDamaged) {
  const TemporaryFolder folder;
  std::ofstream(folder / "metadata.yaml") << "rosbag2_bagfile_information:\n";
  test::SqliteWriter(folder / "bag_0.db3").Write(SomeMessages());
  std::ofstream(folder / "bag_1.db3") << std::string(1000, 'x');
  test::ExpectRefused([&] { OpenSource(folder.path()); }, "bag_1.db3: expected a ROS 2 bag");
}

TEST(Ros2Folder, OfSeveralRecordingsAsksForOne) {
  const TemporaryFolder folder;
  WriteMcap(folder / "a.mcap", SomeMessages());
  ExpectSomeFrames(folder.path());
  WriteMcap(folder / "b.mcap", SomeMessages());
  test::ExpectRefused([&] { OpenSource(folder.path()); }, "name one of them, such as a.mcap");
}

TEST(Ros2Folder, OfCompressedFilesNamesTheCommandThatUnpacksThem) {
  const TemporaryFolder folder;
  std::ofstream(folder / "metadata.yaml") << "rosbag2_bagfile_information:\n";
  std::ofstream(folder / "bag_0.db3.zstd") << "x";
  EXPECT_TRUE(IsRecording(folder.path()));
  test::ExpectRefused([&] { OpenSource(folder.path()); }, "'zstd -d FILE' unpacks it");
  test::ExpectRefused([&] { OpenSource(folder / "bag_0.db3.zstd"); }, "'zstd -d FILE' unpacks it");
}

// As librealsense 2.59 names its topics.
TEST(RealSenseDb3, HasItsUnitAndItsCamera) {
  const TemporaryFolder folder;
  const std::string sensor = "/device_0/sensor_0/";
  Ros2Message image = ImageOf(100, 4000);
  image.topic = sensor + "Depth_0/image/data";
  Ros2Message infrared = ImageOf(100, 7);
  infrared.topic = sensor + "Infrared_1/image/data";
  test::SqliteWriter(folder / "x.db3")
      .Write({{sensor + "Depth_0/camera_info", "std_msgs/msg/String",
               RosBytes(kCdr)
                   .AddText("width=4;height=2;fx=366.5;ppx=2;fy=366.5;ppy=1;model=Brown Conrady;"
                            "coeffs=0,0,0,0,0")
                   .bytes},
              {sensor + "option/Depth_Units/value", "std_msgs/msg/String",
               RosBytes(kCdr).AddText("0.000250").bytes},
              infrared,
              image});
  const auto source = OpenSource(folder / "x.db3");
  EXPECT_EQ(source->camera(), (Camera{4, 2, 366.5, 366.5, 2, 1}));
  EXPECT_EQ(FramesOf(*source)[0].depth_mm[0], 1000);
}

// Its recorder (OrbbecSDK 2) numbers sensors and streams: 1 is infrared, 3 depth. The images' own
// fields are followed by more of theirs.
TEST(OrbbecMcap, HasItsDepthAndItsCamera) {
  const TemporaryFolder folder;
  const auto image = [](int sensor, uint16_t depth) {
    auto bytes = test::RosImageBytes("mono16", 4, 2, std::vector<uint16_t>(8, depth), 8);
    bytes.resize(bytes.size() + 48);
    const std::string number = std::to_string(sensor);
    return Ros2Message{"/cam/sensor_" + number + "/frameType_" + number, "sensor_msgs/Image",
                       bytes};
  };
  RosBytes profile;
  profile.AddHeader(100, 0).Add(uint8_t{3}).Add(uint8_t{28});
  for (int i = 0; i < 12; ++i) profile.Add(0.0F);
  profile.Add(uint16_t{4}).Add(uint16_t{2}).Add(uint16_t{30});
  for (const float k : {366.5F, 366.5F, 2.0F, 1.0F}) profile.Add(k);
  for (int i = 0; i < 8; ++i) profile.Add(0.0F);
  profile.Add(uint8_t{4});
  WriteMcap(folder / "x.mcap",
            {image(1, 7),
             image(3, 1000),
             {"/cam/streamProfileType_3", "custom_msg/OBStreamProfileInfo", profile.bytes}},
            {.encoding = "ros1"});
  const auto source = OpenSource(folder / "x.mcap");
  EXPECT_EQ(source->camera(), (Camera{4, 2, 366.5, 366.5, 2, 1}));
  EXPECT_EQ(FramesOf(*source)[0].depth_mm[0], 1000);
}

}  // namespace
}  // namespace ossa::depth
