#include "tests/robustness/recordings.h"

#include <fstream>
#include <iterator>
#include <utility>

#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/mkv_writer.h"
#include "tests/depth/sensor/xef_writer.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#ifdef OSSA_TEST_ROSBAG
#include "tests/depth/sensor/bag_writer.h"
#include "tests/depth/sensor/ros_bytes.h"
#endif
#ifdef OSSA_TEST_ROSBAG2
#include "tests/depth/sensor/ros2_writer.h"
#endif
#ifdef OSSA_TEST_ARRAYS
#include "tests/depth/sensor/array_writer.h"
#endif

namespace ossa::test {
namespace {

bool HasReader(const char* program) {
  return std::filesystem::exists(BinaryFolder() / "lib/openni2/reader" / program);
}

std::string ContentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

#ifdef OSSA_TEST_ROSBAG
DamageSample Bag(const std::string& name, rosbag::compression::CompressionType compression) {
  const TemporaryFolder folder;
  rosbag::Bag bag;
  bag.open(folder / name, rosbag::bagmode::Write);
  bag.setCompression(compression);
  for (uint32_t i = 0; i < 3; ++i) {
    const uint32_t second = 100 + i;
    const depth::DepthFrame frame = ExampleFrame(static_cast<int>(i), 4, 3);
    const auto bytes = RosImageBytes("16UC1", 4, 3, frame.depth_mm, 8, false, second);
    bag.write("/depth/image", ros::Time(second, 0), RawMessage{"sensor_msgs/Image", bytes});
    bag.write("/depth/camera_info", ros::Time(second, 0),
              RawMessage{"sensor_msgs/CameraInfo", RosCameraInfoBytes(4, 3, 366)});
  }
  bag.close();
  return {name, ContentOf(folder / name), ReadRecording};
}
#endif

#ifdef OSSA_TEST_ROSBAG2
std::vector<Ros2Message> ExampleMessages() {
  constexpr auto kCdr = depth::RosWire::kCdr;
  std::vector<Ros2Message> messages;
  for (uint32_t i = 0; i < 3; ++i) {
    const depth::DepthFrame frame = ExampleFrame(static_cast<int>(i), 4, 3);
    messages.push_back({"/depth/image", "sensor_msgs/msg/Image",
                        RosImageBytes("16UC1", 4, 3, frame.depth_mm, 8, false, 100 + i, kCdr)});
    messages.push_back({"/depth/camera_info", "sensor_msgs/msg/CameraInfo",
                        RosCameraInfoBytes({.width = 4, .height = 3, .f = 366.0}, kCdr)});
  }
  return messages;
}

DamageSample SqliteBag() {
  const TemporaryFolder folder;
  SqliteWriter(folder / "x.db3").Write(ExampleMessages());
  return {"x.db3", ContentOf(folder / "x.db3"), ReadRecording};
}

DamageSample Mcap(const std::string& name, const McapForm& form) {
  const auto bytes = McapWriter(form).Write(ExampleMessages());
  return {name, {bytes.begin(), bytes.end()}, ReadRecording};
}
#endif

#ifdef OSSA_TEST_ARRAYS
// Three images of 20 x 16, row by row; the order does not matter here.
std::vector<DamageSample> Arrays() {
  const Shape shape = {3, 16, 20};
  std::vector<uint16_t> numbers;
  for (int i = 0; i < 3; ++i) {
    const std::vector<uint16_t> depths = ExampleFrame(i, 20, 16).depth_mm;
    numbers.insert(numbers.end(), depths.begin(), depths.end());
  }
  const std::string npy = NpyBytes("<u2", shape, numbers);
  const TemporaryFolder folder;
  WriteNpz(folder / "x.npz", {{"depth", npy}}, true);
  MatWriter(folder / "x.mat").Add("depth", MAT_C_UINT16, MAT_T_UINT16, {16, 20, 3}, numbers);
  Hdf5Writer(folder / "x.h5").Add("depth", H5T_STD_U16LE, shape, numbers);
  std::vector<DamageSample> samples = {{"x.npy", npy, ReadRecording}};
  for (const char* name : {"x.npz", "x.mat", "x.h5"}) {
    samples.push_back({name, ContentOf(folder / name), ReadRecording});
  }
  return samples;
}
#endif

// Archived, of flat images: the sizes of others are those of the camera.
DamageSample Xef() {
  XefWriter writer(true);
  writer.AddStream(1, "Nui Depth", XefWriter::kDepth);
  for (uint16_t i = 0; i < 3; ++i) {
    const std::vector<uint16_t> depths(size_t{512} * 424, static_cast<uint16_t>(1500 + 100 * i));
    writer.AddEvent(1, 333'333U * i, i, depths);
  }
  return {"x.xef", writer.Finish(), ReadRecording};
}

}  // namespace

Reading ReadRecording(const std::filesystem::path& path) {
  Reading reading;
  depth::SourceOptions options;
  options.player_patience = std::chrono::seconds(5);
  options.note = [&reading](depth::NoteKind kind, const std::string&) {
    reading.warned = reading.warned || kind == depth::NoteKind::kWarning;
  };
  const auto source = depth::OpenSource(path.string(), options);
  for (;;) {
    const depth::ReadResult result = source->Read(std::chrono::minutes(1));
    if (result.status != depth::ReadStatus::kFrame) return reading;
    AppendFrame(result.frame, &reading.content);
  }
}

std::vector<DamageSample> PlainRecordings() {
  std::vector<DamageSample> samples;
  if (HasReader("ossa_mkv_reader")) {
    const std::vector<depth::DepthFrame> frames = {ExampleFrame(0, 4, 3), ExampleFrame(1, 4, 3),
                                                   ExampleFrame(2, 4, 3)};
    samples.push_back({"x.mkv", MkvBytes(frames), ReadRecording});
  }
#ifdef OSSA_TEST_ROSBAG
  using rosbag::compression::CompressionType;
  samples.push_back(Bag("x.bag", CompressionType::Uncompressed));
  samples.push_back(Bag("bz2.bag", CompressionType::BZ2));
  samples.push_back(Bag("lz4.bag", CompressionType::LZ4));
#endif
#ifdef OSSA_TEST_ROSBAG2
  samples.push_back(SqliteBag());
  samples.push_back(Mcap("x.mcap", {.has_checksum = false}));
  samples.push_back(Mcap("lz4.mcap", {.compression = "lz4"}));
#endif
#ifdef OSSA_TEST_ARRAYS
  for (DamageSample& sample : Arrays()) samples.push_back(std::move(sample));
#endif
  samples.push_back(Xef());
  for (DamageSample& sample : PlainImages()) samples.push_back(std::move(sample));
  return samples;
}

}  // namespace ossa::test
