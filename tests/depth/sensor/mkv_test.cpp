// Truncated Azure Kinect recordings, and ones whose recorder was killed.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "tests/depth/sensor/mkv_writer.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

struct Reading {
  std::vector<DepthFrame> frames;
  std::vector<std::string> warnings;
};

Reading ReadAll(const std::string& path) {
  Reading reading;
  SourceOptions options;
  options.note = [&](NoteKind kind, const std::string& text) {
    if (kind == NoteKind::kWarning) reading.warnings.push_back(text);
  };
  const auto source = OpenSource(path, options);
  for (;;) {
    ReadResult read = source->Read(std::chrono::milliseconds(1000));
    if (read.status == ReadStatus::kEnd) return reading;
    if (read.status == ReadStatus::kFrame) reading.frames.push_back(std::move(read.frame));
  }
}

// Four frames of 64 x 48, 6 kB each.
class Mkv : public testing::Test {
 protected:
  Mkv() {
    std::vector<DepthFrame> frames;
    for (int i = 0; i < 4; ++i) frames.push_back(test::ExampleFrame(i, 64, 48));
    test::WriteMkv(path_, frames);
  }
  test::TemporaryFolder folder_;
  std::string path_ = folder_ / "x.mkv";
};

TEST_F(Mkv, ReturnsTheFramesThatWereWritten) {
  const Reading reading = ReadAll(path_);
  ASSERT_EQ(reading.frames.size(), 4u);
  EXPECT_TRUE(reading.warnings.empty()) << reading.warnings[0];
  EXPECT_EQ(reading.frames[3].depth_mm, test::ExampleFrame(3, 64, 48).depth_mm);
  EXPECT_NEAR(reading.frames[3].time_s, 0.1, 1e-9);
}

TEST_F(Mkv, TruncatedFileGivesItsCompleteFramesAndAWarning) {
  const auto size = std::filesystem::file_size(path_);
  for (const size_t missing : {size_t{1}, size_t{100}, size_t{7000}, size_t{12000}}) {
    std::filesystem::resize_file(path_, size - missing);
    const Reading reading = ReadAll(path_);
    ASSERT_EQ(reading.warnings.size(), 1u) << missing;
    EXPECT_NE(reading.warnings[0].find("it is cut short"), std::string::npos);
    EXPECT_GE(reading.frames.size(), 1u);
    for (size_t i = 0; i < reading.frames.size(); ++i) {
      EXPECT_EQ(reading.frames[i].depth_mm,
                test::ExampleFrame(static_cast<int>(i), 64, 48).depth_mm);
    }
  }
}

TEST_F(Mkv, UnfinishedRecordingGivesAWarning) {
  std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const size_t segment = bytes.find("\x18\x53\x80\x67");
  ASSERT_NE(segment, std::string::npos);
  file.clear();
  file.seekp(static_cast<std::streamoff>(segment) + 4);
  file << "\x01\xff\xff\xff\xff\xff\xff\xff" << std::flush;  // the size that was not yet known
  const Reading reading = ReadAll(path_);
  EXPECT_EQ(reading.frames.size(), 4u);
  ASSERT_EQ(reading.warnings.size(), 1u);
  EXPECT_NE(reading.warnings[0].find("its recorder was stopped"), std::string::npos);
}

TEST(AzureKinectMkv, TruncationGivesAWarning) {
  const auto genuine = test::SharedFolder() / "real/recordings/azure_kinect.mkv";
  if (!std::filesystem::exists(genuine)) GTEST_SKIP() << "not here: " << genuine;
  const test::TemporaryFolder folder;
  const std::string path = folder / "cut.mkv";
  std::ifstream whole(genuine, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  std::ofstream(path, std::ios::binary) << bytes.substr(0, bytes.size() - 1000);
  EXPECT_EQ(ReadAll(path).warnings.size(), 1u);
}

}  // namespace
}  // namespace ossa::depth
