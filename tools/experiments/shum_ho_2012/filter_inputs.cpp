// Inputs of the filter study: noisy authored motion, sensors with truth, rendered scenes.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/shum_ho_2012/filter_internal.h"
#include "tools/experiments/simulation/motions.h"
#include "tools/experiments/simulation/recording_simulator.h"

namespace ossa::tools {
namespace {

// Constants: of which recordings are shown, by hand.

using Eigen::Vector3d;
using recon::kJointCount;
using recon::Posture;

SparsePosture Whole(const Posture& posture) {
  SparsePosture whole;
  whole.position_m = posture.position_m;
  whole.present.fill(true);
  whole.confidence.fill(1.0);
  return whole;
}

/// Sensor noise: half white, half with a correlation of 0.8 from frame to frame; in one frame of a
/// hundred a joint is 10 cm off.
FilterCase Noisy(const std::vector<Posture>& truth, double sigma_m, uint64_t seed) {
  FilterCase c;
  c.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const auto draw = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  recon::JointArray<Vector3d> wander;
  wander.fill(Vector3d::Zero());
  for (const Posture& t : truth) {
    Posture p = t;
    for (size_t j = 0; j < kJointCount; ++j) {
      wander[j] = 0.8 * wander[j] + 0.6 * draw();
      p.position_m[j] += sigma_m * std::sqrt(0.5) * (wander[j] + draw());
      if (sigma_m > 0.0 && uniform(random) < 0.01) p.position_m[j] += 0.1 * draw();
    }
    c.tracks.time_s.push_back(static_cast<double>(c.tracks.time_s.size()) / 30.0);
    c.tracks.truth.push_back(Whole(t));
    c.tracks.result.push_back(Whole(p));
  }
  return c;
}

FilterData Authored(const ActionClips& clips, double sigma_cm, uint64_t seed) {
  FilterData data{fmt::format("authored, noise {:.0f} cm", sigma_cm), {}};
  for (const char* action : {"walk", "punch", "kick", "tai_chi", "wave", "jumping_jacks", "squat",
                             "throw", "golf", "clap", "stand", "march"}) {
    data.cases.push_back(Noisy(clips.Get(action), 0.01 * sigma_cm, seed + data.cases.size()));
  }
  return data;
}

/// Recordings with their truth: every `stride`-th, if it lasts a second.
FilterData Recorded(const std::string& name, const std::vector<RecordedPair>& pairs, size_t stride,
                    const PairOptions& how) {
  constexpr size_t kLeastFrames = 30;
  FilterData data{name, {}};
  for (size_t k = 0; k < pairs.size(); k += stride) {
    auto tracks = PairUp(pairs[k].truth, pairs[k].observed, how);
    if (tracks.empty() || tracks[0].time_s.size() <= kLeastFrames) continue;
    FilterCase& c = data.cases.emplace_back();
    c.tracks = std::move(tracks[0]);
    if (!how.rigid) c.floor = pairs[k].truth.frames[0].floor;
  }
  return data;
}

double MeanStep_m(const SparsePosture& from, const SparsePosture& to) {
  double sum = 0.0, count = 0.0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!from.present[j] || !to.present[j]) continue;
    sum += (to.position_m[j] - from.position_m[j]).norm();
    ++count;
  }
  return count > 0.0 ? sum / count : 0.0;
}

/// ITOP's frames have no times and unmarked gaps. Joints move 3-5 cm between frames on average:
/// about 10 Hz. At jumps, frames are missing or the person changes.
FilterData InRuns(const FilterData& whole) {
  constexpr double kJump_m = 0.15, kFrame_s = 0.1;
  constexpr size_t kLeastFrames = 15;
  FilterData data{whole.name, {}};
  for (const FilterCase& c : whole.cases) {
    FilterCase run;
    for (size_t f = 0; f <= c.tracks.truth.size(); ++f) {
      const bool end = f == c.tracks.truth.size();
      if (end || (f > 0 && MeanStep_m(c.tracks.truth[f - 1], c.tracks.truth[f]) > kJump_m)) {
        if (run.tracks.truth.size() >= kLeastFrames) data.cases.push_back(run);
        run = {};
      }
      if (end) break;
      run.tracks.time_s.push_back(kFrame_s * static_cast<double>(f));
      run.tracks.truth.push_back(c.tracks.truth[f]);
      run.tracks.result.push_back(c.tracks.result[f]);
    }
  }
  return data;
}

/// The raw joints of ossa's forest on rendered depth images, without and with furniture.
FilterData Rendered(ExperimentContext& context, std::string& note) {
  constexpr size_t kScenes = 6;
  const ShumHoSettings settings = ReadShumHoSettings(context.parameters);
  const int frames = settings.rendered_frames;
  const std::string& observer = settings.observer;
  const StudyMotion motions = StudyMotions(context, kScenes, frames);
  RecordingSimulator simulator(context, observer);
  std::vector<RecordedPair> recorded;
  for (size_t k = 0; k < kScenes; ++k) {
    SequenceOptions sequence;
    sequence.name = fmt::format("filter {}", k);
    sequence.clutter = k % 2 == 0 ? Clutter::kNone : Clutter::kFurniture;
    sequence.frames = frames;
    sequence.seed = context.seed * 100 + k;
    recorded.push_back(simulator.Record(motions.clips[k % motions.clips.size()], sequence));
  }
  note += " Rendered scenes: " + ObserverNote(observer) + motions.note;
  return Recorded("rendered, " + observer, recorded, 1, {.time = TimeAlignment::kNone});
}

}  // namespace

std::vector<FilterData> MakeFilterData(ExperimentContext& context, const ActionClips& clips,
                                       std::string& note) {
  const ShumHoSettings settings = ReadShumHoSettings(context.parameters);
  const double stride = settings.filter_stride;
  std::vector<FilterData> all;
  for (const double sigma_cm : {0.0, 1.0, 3.0}) {
    all.push_back(Authored(clips, sigma_cm, context.seed));
  }
  if (context.shared.empty()) {
    note += " Real recordings left out: no --shared folder was given.";
  } else {
    all.push_back(Recorded("UI-PRMD, Kinect against Vicon", LoadUiPrmd(context.shared, false),
                           static_cast<size_t>(stride), {.time = TimeAlignment::kNone}));
    all.push_back(Recorded("KERAAL, Kinect v2 against Vicon targets", LoadKeraal(context.shared), 1,
                           {.time = TimeAlignment::kCorrelate, .rigid = true}));
    all.push_back(InRuns(Recorded("ITOP side, A2J network", LoadItop(context.shared), 1,
                                  {.time = TimeAlignment::kNone})));
    note += fmt::format(
        " UI-PRMD: every {:.0f}th correct performance. KERAAL: clocks and frames aligned; targets "
        "are no joint centres (5-18 cm off). Real recordings have no floor.",
        stride);
  }
  if (settings.rendered) all.push_back(Rendered(context, note));
  return all;
}

}  // namespace ossa::tools
