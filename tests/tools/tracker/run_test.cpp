// Tracker::Run: every frame of a source once, and what the source lost.
#include <deque>

#include "depth/sensor/frame_source.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

using depth::ReadResult;
using depth::ReadStatus;

/// Gives what it was told, and then throws, or is at its end.
class ScriptedSource final : public depth::FrameSource {
 public:
  explicit ScriptedSource(std::deque<ReadResult> script) : script_(std::move(script)) {}
  ReadResult Read(std::chrono::milliseconds) override {
    if (script_.empty() && damaged) throw InputError("scripted: damaged");
    ReadResult end;
    end.status = ReadStatus::kEnd;
    if (script_.empty()) return end;
    ReadResult next = std::move(script_.front());
    script_.pop_front();
    return next;
  }
  const depth::Camera& camera() const override { return camera_; }
  bool is_live() const override { return true; }
  std::optional<int64_t> frame_count() const override { return std::nullopt; }

  bool damaged = false;

 private:
  std::deque<ReadResult> script_;
  depth::Camera camera_ = Rendered({}).frame.camera;
};

ReadResult Frame(int index, int64_t dropped = 0) {
  ReadResult result{.status = ReadStatus::kFrame, .frame = Rendered({}, index).frame};
  result.frame.index = index;
  result.dropped = dropped;
  return result;
}

ReadResult Nothing(ReadStatus status, int64_t dropped = 0) {
  ReadResult result;
  result.status = status;
  result.dropped = dropped;
  return result;
}

std::vector<int64_t> IndicesOf(Tracker& tracker, ScriptedSource& source) {
  std::vector<int64_t> seen;
  tracker.Run(source, [&](const BodyFrame& bodies) {
    seen.push_back(bodies.index);
    return true;
  });
  return seen;
}

TrackerOptions WithLag(int lag) {
  TrackerOptions options = PlainOptions();
  options.lag = lag;
  return options;
}

TEST(TrackerRun, CountsDroppedFrames) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  ScriptedSource source({Frame(0, 1), Nothing(ReadStatus::kTimeout, 2), Frame(1),
                         Nothing(ReadStatus::kDisconnected, 4), Frame(2, 8),
                         Nothing(ReadStatus::kEnd, 16)});
  EXPECT_EQ(tracker.Run(source, [](const BodyFrame&) { return true; }), 31);
}

TEST(TrackerRun, ReportsEveryFrameOnceForAnyLag) {
  OSSA_NEEDS_MODEL();
  for (const int lag : {0, 1, 2}) {
    Tracker tracker(WithLag(lag));
    ScriptedSource source({Frame(3), Nothing(ReadStatus::kTimeout), Frame(5), Frame(6), Frame(9)});
    EXPECT_EQ(IndicesOf(tracker, source), (std::vector<int64_t>{3, 5, 6, 9})) << lag;
  }
}

TEST(TrackerRun, EndsOnRequestOfItsCallback) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(PlainOptions());
  ScriptedSource source({Frame(0, 1), Frame(1, 2), Frame(2, 4)});
  int seen = 0;
  EXPECT_EQ(tracker.Run(source, [&](const BodyFrame&) { return ++seen < 2; }), 3);
  EXPECT_EQ(seen, 2);
}

TEST(TrackerRun, KeepsTheFramesBeforeADamagedOne) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(WithLag(2));
  ScriptedSource source({Frame(0), Frame(1), Frame(2)});
  source.damaged = true;
  std::vector<int64_t> seen;
  const auto keep = [&](const BodyFrame& bodies) {
    seen.push_back(bodies.index);
    return true;
  };
  EXPECT_THROW(tracker.Run(source, keep), InputError);
  while (const auto held = tracker.DrainLag()) keep(*held);
  EXPECT_EQ(seen, (std::vector<int64_t>{0, 1, 2}));
}

}  // namespace
}  // namespace ossa::tracker
