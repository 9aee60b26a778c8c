#include "tools/experiments/sdk/method_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "depth/base/error.h"
#include "depth/base/statistics.h"
#include "depth/base/stopwatch.h"
#include "recon/database/posture_database.h"
#include "recon/methods/reconstruct_sequence.h"
#include "recon/methods/recorded_pairs.h"
#include "recon/models/posture_prior.h"
#include "tools/experiments/compare/sequence_text.h"
#include "tools/experiments/sdk/sdk_internal.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/shipped.h"

namespace ossa::tools {
namespace {

std::string ComputeKey(const ExperimentContext& context, const MethodRun& run) {
  const recon::ReconstructorOptions& o = run.options;
  const auto& pca = o.local_pca;
  const auto& gp = o.gaussian_process;
  const auto& best = o.best;
  std::string key = fmt::format(
      "{} {} seed {} pca {} {} {} {} {} {} {} {} {} {} {} {} gp {} {} {} {} {} "
      "best {} {} {} {} {} {} {} {}",
      ComputeCodeKey(), o.method, o.seed, pca.neighbours, pca.dimensions, pca.steps, pca.samples,
      pca.control, pca.style, pca.kinematics, pca.continuity, pca.solver, pca.use_reliability,
      pca.extend_database, pca.keep_reliable, gp.nearby_models, gp.spatial, gp.temporal,
      gp.reliability, gp.incremental, best.refined_joints, best.repair, best.correct, best.window,
      best.bones, best.complete, best.filter, DescribeConstants(best.constants));
  if (o.database) {
    key.append(" ").append(run.database_key.empty() ? ComputeFileKey(LoadDatabase(context).path)
                                                    : run.database_key);
  }
  if (o.prior) key.append(" ").append(ComputeFileKey(tracker::ShippedFile(recon::kShippedPrior)));
  if (!o.learned_file.empty()) key.append(" ").append(ComputeFileKey(o.learned_file));
  if (run.physics) key.append(" physics");
  return key;
}

}  // namespace

OpenDatabase LoadDatabase(const ExperimentContext& context) {
  OpenDatabase database;
  database.path =
      context.database.empty() ? tracker::ShippedFile("authored.ossadb") : context.database;
  static std::map<std::filesystem::path, std::shared_ptr<const recon::PostureDatabase>> kOpen;
  auto& open = kOpen[database.path];
  if (!open) {
    open = std::make_shared<recon::PostureDatabase>(recon::PostureDatabase::Load(database.path));
  }
  database.postures = open;
  return database;
}

bool ReadUsesPrior(Parameters& parameters) {
  return parameters.Integer("best_prior", 1, 0, 1) != 0;
}

std::shared_ptr<const recon::PosturePrior> LoadPrior(ExperimentContext& context) {
  if (!ReadUsesPrior(context.parameters) || !context.database.empty()) return nullptr;
  static const auto kShipped = std::make_shared<const recon::PosturePrior>(
      recon::PosturePrior::Load(tracker::ShippedFile(recon::kShippedPrior)));
  return kShipped;
}

void SetObserverCorrection(const std::string& observer, MethodRun* best) {
  if (observer != "forest") return;
  best->options.learned_file = tracker::ShippedFile("body.ossagp");
  best->refines = true;
}

MethodRun WithPhysics(MethodRun run) {
  run.label += " + physics";
  run.physics = true;
  return run;
}

recon::SkeletonSequence RunMethod(const ExperimentContext& context, const MethodRun& run,
                                  const recon::SkeletonSequence& observed) {
  if (observed.frames.empty()) return observed;  // a text of no frames is refused
  const std::string key = ComputeKey(context, run) + " on " + ContentHash(FormatSequence(observed));
  const std::string text = context.Cached(key, [&] {
    const auto go_on = [&](size_t) {
      context.ThrowIfInterrupted();
      return true;
    };
    auto made = recon::ReconstructSequence(observed, run.options, go_on);
    if (run.physics) tracker::FollowMechanically(made, {}, go_on);
    return FormatSequence(made);
  });
  return ParseSequence(text, observed.source);
}

PairedTracks PairClip(const std::string& name, const recon::SkeletonSequence& truth,
                      const recon::SkeletonSequence& result) {
  auto pairs = PairUp(truth, result, {.time = TimeAlignment::kNone});
  if (pairs.empty()) return {name, {}, {}, {}};
  pairs[0].name = name;
  return std::move(pairs[0]);
}

ClipMetrics MeasureClip(const std::string& name, const recon::SkeletonSequence& truth,
                        const recon::SkeletonSequence& result) {
  return Measure(PairClip(name, truth, result));
}

std::vector<PairedTracks> RunOverClips(const ExperimentContext& context, const MethodRun& run,
                                       const std::vector<RecordedPair>& clips) {
  std::vector<PairedTracks> pairs;
  for (const RecordedPair& clip : clips) {
    context.ThrowIfInterrupted();
    MethodRun with = run;
    with.options.best.refined_joints = run.refines && !clip.refined.frames.empty();
    const auto made =
        RunMethod(context, with, with.options.best.refined_joints ? clip.refined : clip.observed);
    pairs.push_back(PairClip(clip.clip, clip.truth, made));
    if (context.progress) {
      context.progress(static_cast<double>(pairs.size()), static_cast<double>(clips.size()),
                       run.label + " " + clip.clip);
    }
  }
  return pairs;
}

std::vector<ClipMetrics> MeasureAll(const std::vector<PairedTracks>& pairs) {
  std::vector<ClipMetrics> metrics;
  for (const PairedTracks& pair : pairs) metrics.push_back(Measure(pair));
  return metrics;
}

double MedianStep_ms(const MethodRun& run, const recon::SkeletonSequence& observed) {
  const auto method = recon::MakeReconstructor(run.options);
  std::vector<double> times_ms;
  for (const recon::SkeletonFrame& frame : observed.frames) {
    if (frame.bodies.empty()) continue;
    const recon::TrackedPosture posture = recon::ToTrackedPosture(frame.bodies[0]);
    const Stopwatch watch;
    method->Step({posture, frame.time_s, nullptr});
    times_ms.push_back(watch.milliseconds());
  }
  if (times_ms.empty()) return 0.0;
  return ossa::Median(std::move(times_ms));
}

std::filesystem::path LearnWithout(const ExperimentContext& context,
                                   const std::vector<RecordedPair>& clips,
                                   const std::string& left_out,
                                   const recon::LearnOptions& options) {
  std::string key =
      fmt::format("learn {} {} {} {} {} {} {} {}", ComputeCodeKey(), options.mixture.regions,
                  options.mixture.samples, options.mixture.seed, options.most_pairs,
                  options.full_samples, options.correction.centres, options.correction.most_pairs);
  std::vector<recon::PosturePair> pairs;
  std::map<std::string, int> people;
  for (const RecordedPair& clip : clips) {
    if (clip.subject == left_out && !left_out.empty()) continue;
    key.append(" ").append(ContentHash(FormatSequence(clip.observed) + FormatSequence(clip.truth)));
    const int person =
        people.try_emplace(clip.subject, static_cast<int>(people.size())).first->second;
    recon::AddPairs(clip.observed, clip.truth, pairs, person);
  }
  if (pairs.empty()) throw InputError("learning: expected pairs of postures, found none");
  const auto path = context.out / "cache" / (ContentHash(key) + ".ossagp");
  if (std::filesystem::exists(path)) return path;
  context.ThrowIfInterrupted();
  if (context.progress) {
    context.progress(0, 1,
                     fmt::format("learning from {} pairs without {}", pairs.size(), left_out));
  }
  const auto models = recon::LearnedModels::Learn(pairs, options, [&](int) {
    context.ThrowIfInterrupted();
    return true;
  });
  std::filesystem::create_directories(path.parent_path());
  models.Save(path);
  return path;
}

std::optional<double> Average(const std::vector<ClipMetrics>& clips,
                              std::optional<double> ClipMetrics::*member) {
  double sum = 0.0, count = 0.0;
  for (const ClipMetrics& clip : clips) {
    if (clip.*member) sum += *(clip.*member), count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

std::optional<double> Median(const std::vector<ClipMetrics>& clips,
                             std::optional<double> ClipMetrics::*member) {
  std::vector<double> values;
  for (const ClipMetrics& clip : clips) {
    if (clip.*member) values.push_back(*(clip.*member));
  }
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string MeanAndMedian(const std::vector<ClipMetrics>& clips,
                          std::optional<double> ClipMetrics::*member) {
  const std::string mean = Cell(Average(clips, member));
  if (clips.size() < 3) return mean;
  return fmt::format("{} ({})", mean, Cell(Median(clips, member)));
}

std::string Cell(const std::optional<double>& value, int digits, double scale) {
  return value ? fmt::format("{:.{}f}", scale * *value, digits) : "-";
}

}  // namespace ossa::tools
