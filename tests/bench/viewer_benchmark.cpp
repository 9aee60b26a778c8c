// What browsers cost the tracker: a frame of 640 x 480 with one person, tracked with the page shut,
// open, and with browsers that take every frame they can get.
//   taskset -c 0,1 build/bin/viewer_benchmark
// `CPU` is that of the tracker's thread, `Time` the frame's; the counter says how many frames a
// browser got for each one tracked.
#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <thread>
#include <vector>

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
    if (viewer) viewer->Show(MomentOf(std::move(frame), std::move(bodies)));
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

}  // namespace
}  // namespace ossa::viewer
