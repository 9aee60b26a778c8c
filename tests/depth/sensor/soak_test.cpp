// A camera that is repeatedly unplugged, for some seconds: only frames of the gaps may be lost, and
// memory must not grow. The long form is tests/bench/soak.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "depth/sensor/frame_source.h"
#include "tests/support/depth_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::depth {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;
using test::ExampleFrame;
using test::TemporaryFolder;
using test::WriteExampleFolder;

constexpr int kPictures = 8;
constexpr int kWidth = 160;
constexpr int kHeight = 120;
constexpr int kFramesAPlug = 15;
constexpr milliseconds kUnplugged{60};

size_t HeapInUse() { return mallinfo2().uordblks; }

struct Soak {
  int64_t frames = 0;
  int64_t dropped = 0;
  int64_t last_index = -1;
  std::vector<milliseconds> gaps;  // each from the last frame before to the first after it
  int64_t foreign = 0;             // frames that are none of the folder's
  std::vector<size_t> heap;        // in use, after each gap
};

// Times between the frames before and after a gap, by our own clock.
class GapWatch {
 public:
  explicit GapWatch(Soak* soak) : soak_(soak) {}
  void Gone() { gone_ = true; }
  void Frame() {
    const auto now = Clock::now();
    if (gone_) soak_->gaps.push_back(std::chrono::duration_cast<milliseconds>(now - last_));
    gone_ = false;
    last_ = now;
  }

 private:
  Soak* soak_;
  bool gone_ = false;
  Clock::time_point last_ = Clock::now();
};

Soak ReadThroughGaps(FrameSource& source, size_t gaps) {
  std::vector<DepthFrame> pictures;
  for (int i = 0; i < kPictures; ++i) pictures.push_back(ExampleFrame(i, kWidth, kHeight));
  Soak soak;
  GapWatch watch(&soak);
  const auto give_up = Clock::now() + std::chrono::minutes(2);
  while (soak.gaps.size() < gaps && Clock::now() < give_up) {
    const ReadResult read = source.Read(milliseconds(50));
    if (read.status == ReadStatus::kDisconnected) watch.Gone();
    if (read.status != ReadStatus::kFrame) continue;
    const size_t before = soak.gaps.size();
    watch.Frame();
    ++soak.frames;
    soak.dropped += read.dropped;
    soak.last_index = read.frame.index;
    soak.foreign += std::none_of(pictures.begin(), pictures.end(), [&](const DepthFrame& picture) {
      return picture.depth_mm == read.frame.depth_mm;
    });
    if (soak.gaps.size() != before) soak.heap.push_back(HeapInUse());
  }
  return soak;
}

TEST(Soak, TwentyUnplugsLoseOnlyTheirGapsAndNoMemory) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), kPictures, kWidth, kHeight);
  const auto source =
      OpenSource("openni:ossa://" + folder.path().string() +
                 "?loop=1&fps=60&unplug_after=" + std::to_string(kFramesAPlug) +
                 "&replug_after_ms=" + std::to_string(kUnplugged.count()) + "&unplugs=1000");
  constexpr size_t kEarly = 8;
  constexpr size_t kGaps = 20;
  Soak soak = ReadThroughGaps(*source, kGaps);
  ASSERT_EQ(soak.gaps.size(), kGaps);
  EXPECT_EQ(soak.foreign, 0);
  EXPECT_EQ(soak.last_index, soak.frames + soak.dropped - 1) << "each frame is given or counted";
  // Busy machines lose frames between the gaps as well; half must arrive.
  EXPECT_GE(soak.frames, kGaps * kFramesAPlug / 2);
  // The requirement: frames within a second of reconnection. For the median, as a busy machine may
  // delay any single one.
  std::nth_element(soak.gaps.begin(), soak.gaps.begin() + kGaps / 2, soak.gaps.end());
  EXPECT_LE(soak.gaps[kGaps / 2], kUnplugged + milliseconds(1000));
  // OpenNI2 keeps about 1.3 kB of every disconnected device, and up to four frames may be in flight
  // when the heap is measured: the smallest of five readings counts. A leak of ours would be at
  // least a frame or a thread per gap.
  constexpr double kFrameBytes = 2.0 * kWidth * kHeight;
  const auto least_until = [&](size_t gap) {
    const auto end = soak.heap.begin() + static_cast<std::ptrdiff_t>(gap);
    return static_cast<double>(*std::min_element(end - 5, end));
  };
  const double grown = least_until(kGaps) - least_until(kEarly);
  EXPECT_LT(grown, (kGaps - kEarly) * 4e3 + 4 * kFrameBytes);
  static_assert((kGaps - kEarly) * kFrameBytes > 2 * ((kGaps - kEarly) * 4e3 + 4 * kFrameBytes));
}

}  // namespace
}  // namespace ossa::depth
