// What a frame costs, depth in to skeletons out, 640 x 480 with noise, method and physics on:
//   build/bin/tracker_benchmark
// Counters: median and 99th percentile of a frame in milliseconds, most memory of the process in
// MB. Threads are the tracker's own; pin the program to as many cores (taskset -c 0,1).
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>

#include "tests/support/capsule_person.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {
namespace {

constexpr int kFrames = 30;  // of different noise and posture, made before the clock runs

tests::CapsulePose PersonAt(double x_m, double z_m, double phase) {
  tests::CapsulePose pose;
  pose.feet_m = {x_m + 0.1 * phase, -1.0, z_m};  // who never moves may be furniture
  pose.left_lift_rad = 0.6 + 0.4 * phase;
  pose.right_lift_rad = 0.6 - 0.4 * phase;
  return pose;
}

std::vector<depth::DepthFrame> Frames(int people) {
  std::vector<depth::DepthFrame> frames;
  for (int f = 0; f < kFrames; ++f) {
    tests::CapsuleScene scene;
    // To and fro, so that the frames can be played round and round.
    const double phase = std::abs(2.0 * f / kFrames - 1);
    for (int i = 0; i < people; ++i) {
      const double x_m = people == 1 ? 0 : -1.9 + 3.8 * i / (people - 1);
      scene.people.push_back(PersonAt(x_m, people == 1 ? 2.5 : i % 2 ? 4.2 : 3.6, phase));
    }
    scene.planes = tests::EmptyRoom();
    scene.noise_m = 0.0015;  // of a Kinect at 1 m, growing with the square
    scene.seed = static_cast<uint64_t>(f) + 1;
    frames.push_back(tests::Render(scene, depth::KinectV1Camera(640, 480)).frame);
  }
  return frames;
}

double PeakMegabytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024;
  }
  return 0;
}

// people, threads
void Track_640x480_ms(benchmark::State& state) {
  const auto people = static_cast<int>(state.range(0));
  TrackerOptions options;
  options.physics = true;
  options.threads = static_cast<int>(state.range(1));
  Tracker tracker(options);
  std::vector<depth::DepthFrame> frames = Frames(people);
  std::vector<double> ms;
  int64_t index = 0;
  size_t fewest = 99;
  for (auto _ : state) {
    depth::DepthFrame& frame = frames[static_cast<size_t>(index % kFrames)];
    frame.index = index;
    frame.time_s = static_cast<double>(index++) / 30.0;
    const auto start = std::chrono::steady_clock::now();
    const BodyFrame bodies = tracker.Track(frame);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    ms.push_back(took.count());
    if (index > 10) fewest = std::min(fewest, bodies.bodies.size());
  }
  std::sort(ms.begin(), ms.end());
  state.counters["median_ms"] = ms[ms.size() / 2];
  state.counters["p99_ms"] = ms[ms.size() * 99 / 100];
  state.counters["peak_MB"] = PeakMegabytes();
  state.counters["fewest_bodies"] = static_cast<double>(fewest);
}
BENCHMARK(Track_640x480_ms)
    ->Args({1, 1})
    ->Args({6, 1})
    ->Args({6, 2})
    ->Iterations(300)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace ossa::tracker
