#include "depth/sensor/oni_recorder.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <optional>
#include <random>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "tests/support/depth_examples.h"
#include "tests/support/full_disk.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using std::chrono::milliseconds;
using test::ExampleFrame;
using test::TemporaryFolder;

std::vector<DepthFrame> ReadAll(FrameSource& source) {
  std::vector<DepthFrame> frames;
  for (;;) {
    ReadResult result = source.Read(milliseconds(60000));
    if (result.status != ReadStatus::kFrame) break;
    frames.push_back(std::move(result.frame));
  }
  return frames;
}

void Record(const std::filesystem::path& path, const std::vector<DepthFrame>& frames) {
  OniRecorder recorder(path, frames.front().camera);
  for (const DepthFrame& frame : frames) recorder.Write(frame);
  recorder.Finish();
}

// Frames that each exercise one rule of the codec; OpenNI2's own player is the reference.
std::vector<DepthFrame> HardFrames() {
  constexpr int kWidth = 640;
  constexpr int kHeight = 480;
  std::mt19937 random(1);
  const std::vector<uint16_t (*)(std::mt19937&, int)> rules = {
      [](std::mt19937&, int) { return uint16_t{0}; },                        // one value: runs
      [](std::mt19937&, int i) { return static_cast<uint16_t>(i / 640); },   // small steps
      [](std::mt19937& r, int) { return static_cast<uint16_t>(r() % 64); },  // byte jumps
      [](std::mt19937& r, int) { return static_cast<uint16_t>(r() % 32767 * 2); },  // word jumps
      [](std::mt19937& r, int) { return r() % 3 == 0 ? kLargestOniDepth_mm : uint16_t{7}; },
      // An odd last pixel after a run: what OpenNI2's own encoder gets wrong.
      [](std::mt19937&, int i) { return static_cast<uint16_t>(i == 640 * 480 - 1 ? 3 : 0); }};
  std::vector<DepthFrame> frames;
  for (const auto rule : rules) {
    DepthFrame frame;
    frame.camera = KinectV1Camera(kWidth, kHeight);
    frame.time_s = 7.0 + static_cast<double>(frames.size()) / 30.0;
    for (int i = 0; i < kWidth * kHeight; ++i) frame.depth_mm.push_back(rule(random, i));
    frames.push_back(std::move(frame));
  }
  return frames;
}

TEST(OniRecorder, OpenNi2PlaysBackEveryPixel) {
  const TemporaryFolder folder;
  const std::vector<DepthFrame> frames = HardFrames();
  Record(folder / "x.oni", frames);
  const auto source = OpenSource((folder / "x.oni").string());
  EXPECT_EQ(source->frame_count(), static_cast<int64_t>(frames.size()));
  EXPECT_FALSE(source->is_live());
  const auto back = ReadAll(*source);
  ASSERT_EQ(back.size(), frames.size());
  for (size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(back[i].depth_mm, frames[i].depth_mm) << "frame " << i;
    EXPECT_EQ(back[i].index, static_cast<int64_t>(i));
    // Time stamps are whole microseconds since the first frame.
    EXPECT_NEAR(back[i].time_s, frames[i].time_s - 7.0, 0.5e-6 + 1e-12);
  }
  EXPECT_EQ(source->Read(milliseconds(10)).status, ReadStatus::kEnd);
}

TEST(OniRecorder, KeepsTheExactCameraAndOddSizes) {
  const TemporaryFolder folder;
  DepthFrame frame = ExampleFrame(0, 7, 3);
  frame.camera = {7, 3, 5.25, 5.5, 3.1, 1.7};
  Record(folder / "x.oni", {frame});
  const auto source = OpenSource((folder / "x.oni").string());
  EXPECT_EQ(source->camera(), frame.camera);
  EXPECT_EQ(ReadAll(*source).at(0).depth_mm, frame.depth_mm);
  const SourceOptions options{.camera = Camera{0, 0, 9, 9, 4, 2}, .device_wait = {}};
  EXPECT_EQ(OpenSource((folder / "x.oni").string(), options)->camera(), (Camera{7, 3, 9, 9, 4, 2}));
}

std::string BytesOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(OniRecorder, TheSameFramesGiveTheSameBytes) {
  const TemporaryFolder folder;
  for (const char* name : {"a.oni", "b.oni"}) {
    Record(folder / name, {ExampleFrame(0), ExampleFrame(1)});
  }
  EXPECT_EQ(BytesOf(folder / "a.oni"), BytesOf(folder / "b.oni"));
}

TEST(OniRecorder, RefusesValuesThatTheFormatCannotHold) {
  const TemporaryFolder folder;
  DepthFrame frame = HardFrames().front();
  OniRecorder recorder(folder / "x.oni", frame.camera);
  recorder.Write(frame);
  const auto refused = [&](const std::string& words) {
    try {
      recorder.Write(frame);
      ADD_FAILURE() << "written: " << words;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("x.oni: frame 1: " + words), std::string::npos)
          << error.what();
    }
  };
  frame.depth_mm[5] = 65535;
  refused("expected depths of at most 65534 mm, found 65535");
  for (size_t i = 0; i < 32768; ++i) frame.depth_mm[i] = static_cast<uint16_t>(i);
  refused("expected at most 32767 different depths");
  frame = ExampleFrame(0);
  refused("expected 640x480, found 32x24");
  frame.camera = KinectV1Camera(640, 480);
  refused("expected 640x480, found 640x480 and 768 depths");
}

TEST(OniRecorder, WritesBorrowedImagesOfAnyStride) {
  const TemporaryFolder folder;
  const DepthFrame wide = ExampleFrame(0);
  DepthFrame frame;
  frame.camera = KinectV1Camera(20, 24);
  frame.borrowed = {wide.depth_mm.data(), 20, 24, 32};
  Record(folder / "x.oni", {frame});
  const auto source = OpenSource((folder / "x.oni").string());
  const DepthFrame read = ReadAll(*source).at(0);
  for (int v = 0; v < 24; ++v) {
    for (int u = 0; u < 20; ++u) ASSERT_EQ(read.view().at(u, v), wide.view().at(u, v));
  }
}

// Noise takes three bytes per pixel plus the table: too much only at the largest size.
TEST(OniRecorder, RefusesFramesThatCompressToMoreThanAPlayersBuffer) {
  const TemporaryFolder folder;
  const auto noise = [](int width, int height) {
    DepthFrame frame;
    frame.camera = KinectV1Camera(width, height);
    std::mt19937 random(1);
    frame.depth_mm.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
    for (uint16_t& value : frame.depth_mm) value = static_cast<uint16_t>(random() % 32767);
    return frame;
  };
  const DepthFrame large = noise(1600, 1180);
  Record(folder / "large.oni", {large});
  EXPECT_EQ(ReadAll(*OpenSource((folder / "large.oni").string())).at(0).depth_mm, large.depth_mm);
  const DepthFrame too_large = noise(1600, 1200);
  test::ExpectRefused([&] { Record(folder / "x.oni", {too_large}); }, "x.oni: frame 0: expected");
}

TEST(OniRecorder, RefusesFramesLargerThanAPlayersBuffer) {
  const TemporaryFolder folder;
  EXPECT_THROW(OniRecorder(folder / "x.oni", KinectV1Camera(4000, 3000)), InputError);
  EXPECT_THROW(OniRecorder(folder / "no/folder/x.oni", KinectV1Camera(4, 3)), InputError);
}

// Number of kept frames; none if there is no space even before the first.
int64_t RecordWithin(uint64_t bytes, const std::filesystem::path& path, int frames) {
  const test::FullDisk disk(bytes);
  std::optional<OniRecorder> recorder;
  try {
    recorder.emplace(path, ExampleFrame(0).camera);
    for (int i = 0; i < frames; ++i) recorder->Write(ExampleFrame(i));
    recorder->Finish();
    return recorder->frame_count();
  } catch (const DiskFull&) {
    return recorder ? recorder->FinishWithWhatFits() : 0;
  }
}

// Whatever does not fit, a frame, its end or the file's end: the result is byte for byte a
// recording of the frames that fit.
TEST(OniRecorder, KeepsTheFramesThatFitOnAFullDisk) {
  const TemporaryFolder folder;
  constexpr int kFrames = 9;
  std::vector<std::string> whole = {""};
  for (int count = 1; count <= kFrames; ++count) {
    EXPECT_EQ(RecordWithin(RLIM_INFINITY, folder / "x.oni", count), count);
    whole.push_back(BytesOf(folder / "x.oni"));
  }
  for (uint64_t room = 300; room <= whole.back().size(); room += 53) {
    std::filesystem::remove(folder / "x.oni");
    size_t fit = kFrames;
    while (whole[fit].size() > room) --fit;
    EXPECT_EQ(RecordWithin(room, folder / "x.oni", kFrames), fit) << room << " bytes";
    EXPECT_EQ(std::filesystem::exists(folder / "x.oni"), fit > 0);
    EXPECT_EQ(BytesOf(folder / "x.oni"), whole[fit]) << room << " bytes";
    EXPECT_EQ(std::filesystem::is_empty(folder.path()), fit == 0);
  }
}

TEST(OniRecorder, LeavesNoFileWithoutFinish) {
  const TemporaryFolder folder;
  OniRecorder(folder / "x.oni", ExampleFrame(0).camera).Write(ExampleFrame(0));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace ossa::depth
