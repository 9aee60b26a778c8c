#include "depth/sensor/sensor_clock.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "depth/sensor/frame_source.h"
#include "depth/sensor/oni_format_internal.h"
#include "depth/sensor/oni_recorder.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

constexpr double kPeriod_s = 1.0 / 30.0;

TEST(SensorClock, ReturnsTimeStampsThatGrowUnchanged) {
  SensorClock clock;
  for (const uint64_t stamp_us : {7U, 33340U, 33340U, 9000000U}) {
    EXPECT_DOUBLE_EQ(clock.TimeOf(stamp_us), 1e-6 * static_cast<double>(stamp_us));
  }
}

// A counter of 32 bits starts again after 71.6 minutes of microseconds.
TEST(SensorClock, ContinuesWhenACounterOverflows) {
  SensorClock clock;
  constexpr uint64_t kCounter = uint64_t{1} << 32;
  const double last_s = clock.TimeOf(kCounter - 1000);
  EXPECT_NEAR(clock.TimeOf(uint64_t{32333}), last_s + kPeriod_s, 1e-9);
  EXPECT_NEAR(clock.TimeOf(uint64_t{65666}), last_s + kPeriod_s + 0.033333, 1e-6);
}

TEST(SensorClock, ContinuesFromASetTime) {
  SensorClock clock;
  clock.TimeOf(5.0);
  clock.SetTime(20.0, 1.0);
  EXPECT_DOUBLE_EQ(clock.TimeOf(1.5), 20.5);
}

constexpr std::array kRestarted_s = {0.0, 10.0, 20.0, 0.5, 1.0};  // time stamps
constexpr std::array kContinued_s = {0.0, 10.0, 20.0, 20.0 + kPeriod_s, 20.5 + kPeriod_s};

void Record(const std::filesystem::path& path) {
  OniRecorder recorder(path, test::ExampleFrame(0).camera);
  for (size_t i = 0; i < kRestarted_s.size(); ++i) {
    DepthFrame frame = test::ExampleFrame(static_cast<int>(i));
    frame.time_s = kRestarted_s[i];
    recorder.Write(frame);
  }
  recorder.Finish();
}

void ExpectTimesContinue(const std::filesystem::path& path) {
  const auto source = OpenSource(path.string());
  for (const double expected_s : kContinued_s) {
    const ReadResult read = source->Read(std::chrono::minutes(1));
    ASSERT_EQ(read.status, ReadStatus::kFrame);
    EXPECT_NEAR(read.frame.time_s, expected_s, 1e-6);  // whole microseconds
  }
}

TEST(OniRecorder, TimesContinueWhenTheClockRestarts) {
  const test::TemporaryFolder folder;
  Record(folder / "x.oni");
  ExpectTimesContinue(folder / "x.oni");
}

// Writes the stamps into the frames' records: after a record's header.
std::string Restamped(std::string bytes) {
  const OniRecordHeader wanted{.type = static_cast<uint32_t>(OniRecord::kNewData)};
  const std::string begin(reinterpret_cast<const char*>(&wanted), 2 * sizeof(uint32_t));
  size_t at = 0;
  for (const double stamp_s : kRestarted_s) {
    at = bytes.find(begin, at) + sizeof(OniRecordHeader);
    const auto stamp_us = static_cast<uint64_t>(1e6 * stamp_s);
    std::memcpy(bytes.data() + at, &stamp_us, sizeof stamp_us);
  }
  return bytes;
}

// Renamed properties make it a recording of another program.
TEST(OniReader, TimesContinueWhenTheClockRestarts) {
  const test::TemporaryFolder folder;
  Record(folder / "x.oni");
  std::ifstream written(folder / "x.oni", std::ios::binary);
  std::string bytes = Restamped({std::istreambuf_iterator<char>(written), {}});
  for (const char* ours : {kOniCameraProperty, kOniSealProperty}) bytes[bytes.find(ours)] = 'x';
  std::ofstream(folder / "y.oni", std::ios::binary) << bytes;
  ExpectTimesContinue(folder / "y.oni");
}

TEST(Device, TimesContinueWhenItsClockRestarts) {
  const test::TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 10);
  const auto source =
      OpenSource("openni:ossa://" + folder.path().string() + "?loop=1&restart_clock_after=3");
  double last_s = -1.0;
  for (int frames = 0; frames < 6; ++frames) {
    const ReadResult read = source->Read(std::chrono::minutes(1));
    ASSERT_EQ(read.status, ReadStatus::kFrame);
    EXPECT_GT(read.frame.time_s, last_s);
    last_s = read.frame.time_s;
  }
}

}  // namespace
}  // namespace ossa::depth
