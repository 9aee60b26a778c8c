#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "depth/sensor/frame_source.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"
#include "tools/viewer/recorder_internal.h"

namespace ossa::viewer {
namespace {

using test::ExampleFrame;
using test::TemporaryFolder;

// The only file there.
std::string RecordingIn(const TemporaryFolder& folder) {
  const std::filesystem::directory_iterator files(folder.path());
  return begin(files) == end(files) ? "" : begin(files)->path().string();
}

class UnrecordableFrame : public testing::TestWithParam<depth::DepthFrame> {};

TEST_P(UnrecordableFrame, KeepsTheFramesBeforeIt) {
  const TemporaryFolder folder;
  Recorder recorder(folder.path());
  recorder.Request(true);
  for (int f = 0; f < 5; ++f) recorder.Take(ExampleFrame(f));
  recorder.Take(GetParam());
  EXPECT_FALSE(recorder.requested());
  EXPECT_NE(recorder.status().find("the 5 frames before are in ossa-"), std::string::npos)
      << recorder.status();
  const auto source = depth::OpenSource(RecordingIn(folder));
  EXPECT_EQ(source->frame_count(), 5);
  EXPECT_EQ(source->Read(std::chrono::seconds(5)).frame.depth_mm, ExampleFrame(0).depth_mm);
}

depth::DepthFrame TooDeepFrame() {
  depth::DepthFrame frame = ExampleFrame(5);
  frame.depth_mm[7] = 65535;
  return frame;
}

INSTANTIATE_TEST_SUITE_P(Recorder, UnrecordableFrame,
                         testing::Values(TooDeepFrame(), ExampleFrame(5, 16, 12)));

TEST(Recorder, ReportsAFileThatCannotBeFinished) {
  const TemporaryFolder folder;
  const auto gone = folder.path() / "gone";
  std::filesystem::create_directory(gone);
  Recorder recorder(gone);
  recorder.Request(true);
  recorder.Take(ExampleFrame(0));
  std::filesystem::remove_all(gone);
  recorder.Request(false);
  EXPECT_NO_THROW(recorder.Take(ExampleFrame(1)));
  EXPECT_NE(recorder.status().find("nothing is kept"), std::string::npos) << recorder.status();
}

TEST(Recorder, NamesTwoRecordingsOfTheSameSecondDifferently) {
  const TemporaryFolder folder;
  constexpr std::time_t kNow = 1'700'000'000;
  const std::string first = NameOfNewFile(folder.path(), kNow);
  std::ofstream(folder / first) << "a recording";
  const std::string second = NameOfNewFile(folder.path(), kNow);
  std::ofstream(folder / second) << "another";
  EXPECT_NE(second, first);
  EXPECT_EQ(second, first.substr(0, first.size() - 4) + "-2.oni");
  EXPECT_TRUE(NameOfNewFile(folder.path(), kNow).ends_with("-3.oni"));
}

}  // namespace
}  // namespace ossa::viewer
