// Time a frame of every method of reconstruction, one person, one core; the query of plantard-2016
// against the number of postures; shum-2013 against that of its neighbours; building the pose
// graph; learning from pairs.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>

#include "recon/methods/reconstructor.h"
#include "recon/models/learned_models.h"
#include "recon/models/posture_prior.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

/// As many postures in clips of 1000 frames at 30 Hz: limbs and trunk swing, every clip with speeds
/// and phases of its own, so that successive postures are near each other as in mocap.
std::vector<PostureClip> SwingingClips(int count) {
  std::mt19937_64 rng(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<PostureClip> clips;
  std::array<double, 5> speed{}, phase{};
  for (int i = 0; i < count; ++i) {
    if (i % 1000 == 0) {
      clips.emplace_back().name = "swing " + std::to_string(i);
      for (double& s : speed) s = 0.3 + unit(rng);
      for (double& p : phase) p = 6.3 * unit(rng);
    }
    const auto swing = [&](size_t k) {
      return 0.5 + 0.5 * std::sin(phase[k] + speed[k] * (i % 1000) / 30.0);
    };
    Posture p = test::Gesture(2.5 * swing(0), 2.5 * swing(1), 1.8 * swing(2), swing(3));
    const Eigen::AngleAxisd lean(0.6 * swing(4), Eigen::Vector3d::UnitX());
    for (size_t j = 1; j < 12; ++j) p.position_m[j] = lean * p.position_m[j];
    clips.back().postures.push_back(p);
  }
  return clips;
}

/// A database of about so many postures: what the filter leaves is not known before.
std::shared_ptr<const PostureDatabase> Database(int size) {
  static std::map<int, std::shared_ptr<const PostureDatabase>> made;
  auto& db = made[size];
  if (!db) {
    DatabaseOptions options;
    options.threshold_m = 0.002;
    options.most_edges = 16;
    db = std::make_shared<PostureDatabase>(PostureDatabase::Build(SwingingClips(size), options));
  }
  return db;
}

std::vector<PosturePair> Pairs(int count) {
  std::vector<PosturePair> pairs;
  for (int f = 0; f < count; ++f) {
    PosturePair& pair = pairs.emplace_back();
    pair.observed = test::Motion(f / 10.0);
    pair.known.fill(1.0);
    for (auto& r : pair.residual.position_m) r = {0.02 * std::sin(f / 17.0), 0.01, 0.0};
  }
  return pairs;
}

void Follow(benchmark::State& state, const ReconstructorOptions& options) {
  const auto method = MakeReconstructor(options);
  int64_t frame = 0;
  for (auto _ : state) {
    const double t_s = static_cast<double>(frame++) / 30.0;
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Motion(t_s)));
    for (size_t i = 5; i < 8; ++i) {  // an arm is hidden half of the time
      if (frame / 30 % 2 == 0) seen.state[i] = TrackingState::kNotTracked;
    }
    benchmark::DoNotOptimize(method->Step({seen, t_s, nullptr}));
  }
  if (options.database) state.counters["postures"] = options.database->size();
}

void MethodPerFrame(benchmark::State& state, const std::string& name) {
  static const auto learned =
      std::make_shared<const LearnedModels>(LearnedModels::Learn(Pairs(2500), {}));
  ReconstructorOptions options;
  options.method = name;
  options.database = Database(20000);
  options.learned = learned;
  Follow(state, options);
}

/// best as it is shipped: an arm hidden half of the time comes from a prior, not from a database.
void BestWithPriorPerFrame(benchmark::State& state) {
  PriorClip clip;
  for (const PostureClip& swings : SwingingClips(20000)) {
    clip.postures.insert(clip.postures.end(), swings.postures.begin(), swings.postures.end());
  }
  ReconstructorOptions options;
  options.prior = std::make_shared<PosturePrior>(PosturePrior::Learn({clip}));
  Follow(state, options);
}
BENCHMARK(BestWithPriorPerFrame)->Iterations(300)->Unit(benchmark::kMillisecond);

void Plantard2016PerFrame(benchmark::State& state) {
  ReconstructorOptions options;
  options.method = "plantard-2016";
  options.database = Database(static_cast<int>(state.range(0)));
  Follow(state, options);
}
BENCHMARK(Plantard2016PerFrame)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Iterations(300)
    ->Unit(benchmark::kMillisecond);

/// Motion that no database here holds: trunk and arms lean to the side, and every second somebody
/// stands elsewhere, so that the track is lost.
Posture UnknownMotion(int64_t frame) {
  const auto second = static_cast<double>(frame / 30);
  const double t_s = static_cast<double>(frame) / 30.0 + 17.3 * second;
  Posture p = test::Motion(t_s);
  const double lean_rad = 0.3 + 0.3 * std::sin(2.9 * second + t_s);
  const Eigen::AngleAxisd lean(lean_rad, Eigen::Vector3d::UnitZ());
  for (size_t j = 1; j < 12; ++j) p.position_m[j] = lean * p.position_m[j];
  return p;
}

/// Half and 99 of 100 frames take no longer than the counters say, milliseconds of processor time.
void Plantard2016Lost(benchmark::State& state) {
  ReconstructorOptions options;
  options.method = "plantard-2016";
  options.database = Database(static_cast<int>(state.range(0)));
  const auto method = MakeReconstructor(options);
  std::vector<double> ms;
  for (auto _ : state) {
    const auto frame = static_cast<int64_t>(ms.size());
    const TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(UnknownMotion(frame)));
    const std::clock_t start = std::clock();
    benchmark::DoNotOptimize(method->Step({seen, static_cast<double>(frame) / 30.0, nullptr}));
    ms.push_back(1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::sort(ms.begin(), ms.end());
  state.counters["postures"] = options.database->size();
  state.counters["p50_ms"] = ms[ms.size() / 2];
  state.counters["p99_ms"] = ms[ms.size() * 99 / 100];
}
BENCHMARK(Plantard2016Lost)
    ->Arg(3600)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Iterations(900)
    ->Unit(benchmark::kMillisecond);

/// By K, the neighbours that span the natural posture space.
void Shum2013PerFrame(benchmark::State& state) {
  ReconstructorOptions options;
  options.method = "shum-2013";
  options.database = Database(20000);
  options.local_pca.neighbours = static_cast<int>(state.range(0));
  Follow(state, options);
}
BENCHMARK(Shum2013PerFrame)
    ->Arg(30)
    ->Arg(300)
    ->Arg(3000)
    ->Iterations(30)
    ->Unit(benchmark::kMillisecond);

void BuildGraph(benchmark::State& state) {
  const auto clips = SwingingClips(static_cast<int>(state.range(0)));
  DatabaseOptions options;
  options.threshold_m = 0.002;
  options.most_edges = 16;
  int size = 0;
  for (auto _ : state) size = PostureDatabase::Build(clips, options).size();
  state.counters["postures"] = size;
}
BENCHMARK(BuildGraph)->Arg(500000)->Iterations(1)->Unit(benchmark::kSecond);

void LearnPairs(benchmark::State& state) {
  const auto pairs = Pairs(2500);
  for (auto _ : state) benchmark::DoNotOptimize(LearnedModels::Learn(pairs, {}));
}
BENCHMARK(LearnPairs)->Iterations(1)->Unit(benchmark::kSecond);

const int kRegistered = [] {
  for (const std::string& name : ReconstructionMethods()) {
    benchmark::RegisterBenchmark(("MethodPerFrame/" + name).c_str(), MethodPerFrame, name)
        ->Iterations(300)
        ->Unit(benchmark::kMillisecond);
  }
  return 0;
}();

}  // namespace
}  // namespace ossa::recon
