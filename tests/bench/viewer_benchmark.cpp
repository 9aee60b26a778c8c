// What browsers cost the tracker: a frame of 640 x 480 with one person, tracked with the page shut,
// open, and with browsers that take every frame they can get.
//   taskset -c 0,1 build/bin/viewer_benchmark
// `CPU` is that of the tracker's thread, `Time` the frame's; the counter says how many frames a
// browser got for each one tracked. TwoBrowsers tracks by turns with nobody looking and with two
// browsers, so that what else the machine does meets both: what the page costs, in percent, of the
// thread's CPU time and of the frames a second, at full speed and at a camera's 30 a second; the
// medians of all turns, and how many frames a second a browser got.
#include <benchmark/benchmark.h>

#include <time.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

#include "depth/base/statistics.h"
#include "tests/support/capsule_person.h"
#include "tests/tools/viewer/web_client.h"
#include "tools/tracker/tracker.h"
#include "tools/viewer/viewer.h"

namespace ossa::viewer {
namespace {

constexpr int kFrames = 30;  // of different noise and posture, made before the clock runs

std::vector<depth::DepthFrame> Frames() {
  std::vector<depth::DepthFrame> frames;
  for (int f = 0; f < kFrames; ++f) {
    const double phase = std::abs(2.0 * f / kFrames - 1);  // to and fro, for round and round
    tests::CapsulePose pose;
    pose.feet_m = {0.1 * phase, -1.0, 2.5};
    pose.left_lift_rad = 0.6 + 0.4 * phase;
    pose.right_lift_rad = 0.6 - 0.4 * phase;
    tests::CapsuleScene scene;
    scene.people.push_back(pose);
    scene.planes = tests::EmptyRoom();
    scene.noise_m = 0.0015;  // of a Kinect at 1 m, growing with the square
    scene.seed = static_cast<uint64_t>(f) + 1;
    frames.push_back(tests::Render(scene, depth::KinectV1Camera(640, 480)).frame);
  }
  return frames;
}

// Asks for the next frame as soon as it has one, as a page does.
class Browser {
 public:
  explicit Browser(int port) : thread_([this, port] { Watch(port); }) {}
  Browser(const Browser&) = delete;
  ~Browser() {
    done_ = true;
    thread_.join();
  }
  int64_t frames() const { return frames_; }

 private:
  void Watch(int port) {
    PageClient page(port);
    int64_t seen = -1;
    while (!done_) {
      const std::string message = page.Ask("{\"after\":" + std::to_string(seen) + "}");
      if (!page.heard_binary()) continue;
      seen = HeaderOf(message)["number"];
      ++frames_;
    }
  }

  std::atomic<bool> done_ = false;
  std::atomic<int64_t> frames_ = 0;
  std::thread thread_;
};

// browsers; -1: no page at all
void Track_640x480_ms(benchmark::State& state) {
  static const std::vector<depth::DepthFrame> frames = Frames();
  const bool has_page = state.range(0) >= 0;
  tracker::TrackerOptions options;
  options.models = tracker::ModelSet::Shipped(options.method);
  tracker::Tracker tracker(options);
  ViewerOptions any;
  any.forest = options.models->forest;
  any.port = 0;
  const auto viewer = has_page ? std::make_unique<Viewer>(any) : nullptr;
  std::vector<std::unique_ptr<Browser>> browsers;
  for (int64_t i = 0; i < state.range(0); ++i) {
    browsers.push_back(std::make_unique<Browser>(viewer->port()));
  }
  int64_t n = 0;
  for (auto _ : state) {
    depth::DepthFrame frame = frames[static_cast<size_t>(n % kFrames)];
    frame.time_s = static_cast<double>(n++) / 30.0;
    tracker::BodyFrame bodies = tracker.Track(frame);
    if (viewer) viewer->Show(MakeDisplayFrame(std::move(frame), std::move(bodies)));
    benchmark::DoNotOptimize(bodies);
  }
  for (const auto& browser : browsers) {
    state.counters["frames_a_browser"] =
        static_cast<double>(browser->frames()) / static_cast<double>(n);
  }
}
BENCHMARK(Track_640x480_ms)
    ->Arg(-1)
    ->Arg(0)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(400);

double ThreadTime_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Of some frames: the tracker's thread's CPU time, and all time without waiting for a camera.
struct Spent {
  double cpu_s = 0.0, wall_s = 0.0;
};

// The tracker, its page with two browsers, and the frame's number.
class Watched {
 public:
  Watched() {
    tracker::TrackerOptions options;
    options.models = tracker::ModelSet::Shipped(options.method);
    tracker_ = std::make_unique<tracker::Tracker>(options);
    ViewerOptions any;
    any.forest = options.models->forest;
    any.port = 0;
    viewer_ = std::make_unique<Viewer>(any);
    for (auto& browser : browsers_) browser = std::make_unique<Browser>(viewer_->port());
  }

  // `period_s`: how far frames of the camera lie apart; 0: it never has to be waited for.
  void Run(int frames, bool is_shown, double period_s, Spent& spent) {
    static const std::vector<depth::DepthFrame> made = Frames();
    for (int f = 0; f < frames; ++f) {
      const auto begin = std::chrono::steady_clock::now();
      const double cpu_s = ThreadTime_s();
      depth::DepthFrame frame = made[static_cast<size_t>(number_ % kFrames)];
      frame.time_s = static_cast<double>(number_++) / 30.0;
      tracker::BodyFrame bodies = tracker_->Track(frame);
      if (is_shown) viewer_->Show(MakeDisplayFrame(std::move(frame), std::move(bodies)));
      spent.cpu_s += ThreadTime_s() - cpu_s;
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      spent.wall_s += took.count();
      std::this_thread::sleep_until(begin + std::chrono::duration<double>(period_s));
    }
  }

  int64_t frames_seen() const { return browsers_[0]->frames() + browsers_[1]->frames(); }

 private:
  std::unique_ptr<tracker::Tracker> tracker_;
  std::unique_ptr<Viewer> viewer_;
  std::array<std::unique_ptr<Browser>, 2> browsers_;
  int64_t number_ = 0;
};

// frames a second of the camera; 0: as many as are tracked
void TwoBrowsers_640x480(benchmark::State& state) {
  const double period_s = state.range(0) > 0 ? 1.0 / static_cast<double>(state.range(0)) : 0.0;
  const int block = state.range(0) > 0 ? 30 : 120;  // frames: half a second, a second
  Watched watched;
  Spent first, all;
  std::vector<double> cpu_percent, rate_percent;
  watched.Run(block, true, 0.0, first);
  const int64_t seen = watched.frames_seen();
  for (auto _ : state) {
    Spent alone, shown;
    watched.Run(block, false, period_s, alone);
    watched.Run(block, true, period_s, shown);
    cpu_percent.push_back(100.0 * (shown.cpu_s / alone.cpu_s - 1.0));
    rate_percent.push_back(100.0 * (1.0 - alone.wall_s / shown.wall_s));
    all.wall_s += std::max(shown.wall_s, block * period_s);
  }
  state.counters["cpu_cost_percent"] = Median(cpu_percent);
  state.counters["rate_cost_percent"] = Median(rate_percent);
  state.counters["frames_a_second_a_browser"] =
      static_cast<double>(watched.frames_seen() - seen) / 2.0 / all.wall_s;
}
BENCHMARK(TwoBrowsers_640x480)->Arg(0)->Arg(30)->Unit(benchmark::kMillisecond)->Iterations(16);

}  // namespace
}  // namespace ossa::viewer
