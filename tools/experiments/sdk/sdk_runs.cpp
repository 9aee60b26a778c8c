// Methods over folds of recordings: learn from some people, test on others.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "recon/database/posture_database.h"
#include "recon/filters/butterworth.h"
#include "recon/filters/lag_smoothing.h"
#include "recon/methods/reconstruct_sequence.h"
#include "recon/methods/recorded_pairs.h"
#include "recon/models/posture_prior.h"
#include "tools/experiments/compare/sequence_text.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"
#include "tools/experiments/simulation/jobs.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/shipped.h"

namespace ossa::tools {
namespace {

// The cached metrics of a clip.
constexpr std::array kKept = {&ClipMetrics::mean_joint_error_cm,
                              &ClipMetrics::parent_relative_error_cm,
                              &ClipMetrics::offset_removed_error_cm,
                              &ClipMetrics::acceleration_error_cm_per_frame2,
                              &ClipMetrics::p99_cm,
                              &ClipMetrics::bone_length_variation_percent,
                              &ClipMetrics::fraction_frames_over_20cm};

nlohmann::json ClipToJson(const ClipMetrics& clip) {
  nlohmann::json numbers = {clip.name, clip.frames};
  for (const auto member : kKept) {
    const auto& value = clip.*member;
    numbers.push_back(value ? nlohmann::json(*value) : nlohmann::json());
  }
  return numbers;
}

ClipMetrics ClipFromJson(const nlohmann::json& numbers) {
  ClipMetrics clip;
  clip.name = numbers.at(0).get<std::string>();
  clip.frames = numbers.at(1).get<int64_t>();
  for (size_t k = 0; k < kKept.size(); ++k) {
    const auto& value = numbers.at(k + 2);
    if (!value.is_null()) clip.*kKept[k] = value.get<double>();
  }
  return clip;
}

/// Frames of lag of a method by its name in these tables.
int ParseLag(const std::string& method) {
  if (method == kBestOffline) return recon::kWholeRecording;
  const auto* const later = std::find(kBestLater.begin(), kBestLater.end(), method);
  return later == kBestLater.end() ? 0 : 1 + static_cast<int>(later - kBestLater.begin());
}

// Options of the names that are not methods of their own.
std::string BaseMethod(std::string method) {
  if (method.ends_with(kPlusPhysics)) method.resize(method.size() - kPlusPhysics.size());
  const bool is_best = ParseLag(method) != 0 || method == kBestUnlearned;
  return is_best ? std::string(recon::kDefaultMethod) : method;
}

/// Delays the bodies by some frames; the first frames stay.
recon::SkeletonSequence Delayed(const recon::SkeletonSequence& observed, size_t frames) {
  recon::SkeletonSequence late = observed;
  for (size_t f = frames; f < late.frames.size(); ++f) {
    late.frames[f].bodies = observed.frames[f - frames].bodies;
  }
  return late;
}

}  // namespace

std::string DescribeConstants(const recon::BestConstants& c) {
  return fmt::format("{} {} {} {} {} {}", c.noise_m, c.acceleration, c.posture_share,
                     c.limb_firmness, c.expected_share, c.failure_slack_m);
}

namespace {

/// Key of the recordings' content.
std::map<const RecordedPair*, std::string> MakeKeys(const std::vector<RecordedPair>& pairs) {
  std::map<const RecordedPair*, std::string> keys;
  for (const RecordedPair& pair : pairs)
    keys[&pair] = ContentHash(FormatSequence(pair.observed) + FormatSequence(pair.truth));
  return keys;
}

/// Key of the clips a fold learns from and tests.
std::string ComputeKey(const Fold& fold, const std::map<const RecordedPair*, std::string>& keys) {
  std::string key;
  for (const auto* side : {&fold.train, &fold.test}) {
    for (const RecordedPair* pair : *side) key.append(keys.at(pair));
    key.append(" ");
  }
  return ContentHash(key);
}

}  // namespace

std::string ComputeOptionsKey(const ExperimentContext& context,
                              const recon::ReconstructorOptions& o) {
  return fmt::format(
      "seed {} "
      "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {}",
      o.seed, o.local_pca.neighbours, o.local_pca.dimensions, o.local_pca.steps,
      o.local_pca.samples, o.local_pca.control, o.local_pca.style, o.local_pca.kinematics,
      o.local_pca.continuity, o.local_pca.solver, o.local_pca.use_reliability,
      o.gaussian_process.incremental, o.gaussian_process.nearby_models, o.best.repair,
      o.best.complete, o.best.correct, o.best.window, o.best.filter, o.best.bones,
      o.database ? ComputeFileKey(LoadDatabase(context).path) : "",
      o.prior ? ComputeFileKey(tracker::ShippedFile(recon::kShippedPrior)) : "",
      DescribeConstants(o.best.constants));
}

recon::ReconstructorOptions LearnFold(const Fold& fold, const std::string& method,
                                      const recon::ReconstructorOptions& options) {
  recon::ReconstructorOptions with = options;
  if (!IsLearned(method)) return with;
  recon::LearnOptions learn;
  learn.processes = !HasOptionalCorrection(method);
  if (learn.processes) learn.correction.centres = 0;
  learn.mixture.seed = learn.correction.seed = options.seed;
  with.learned = std::make_shared<const recon::LearnedModels>(
      recon::LearnedModels::Learn(CollectPairs(fold.train), learn));
  return with;
}

FoldScore TestFold(const Fold& fold, const std::string& method,
                   const recon::ReconstructorOptions& options, int threads) {
  std::vector<std::vector<ClipMetrics>> clips(fold.test.size());
  std::vector<double> milliseconds(fold.test.size());
  RunJobs(fold.test.size(), threads, [&](size_t i) {
    const double start_ms = ProcessorTime_ms();
    const auto made = RunMethod(fold.test[i]->observed, method, options);
    milliseconds[i] = ProcessorTime_ms() - start_ms;
    for (const PairedTracks& pair : PairUp(fold.test[i]->truth, made)) {
      clips[i].push_back(Measure(pair));
      clips[i].back().name = fold.test[i]->clip;
    }
  });
  FoldScore score;
  for (size_t i = 0; i < clips.size(); ++i) {
    score.clips.insert(score.clips.end(), clips[i].begin(), clips[i].end());
    score.milliseconds += milliseconds[i];
  }
  return score;
}

nlohmann::json ClipsToJson(const std::vector<ClipMetrics>& clips) {
  auto json = nlohmann::json::array();
  for (const ClipMetrics& clip : clips) json.push_back(ClipToJson(clip));
  return json;
}

std::vector<ClipMetrics> ClipsFromJson(const nlohmann::json& json) {
  std::vector<ClipMetrics> clips;
  for (const auto& clip : json) clips.push_back(ClipFromJson(clip));
  return clips;
}

bool IsLearned(const std::string& method) {
  if (method == kBestUnlearned) return false;
  const recon::MethodInfo* info = recon::FindMethod(BaseMethod(method));
  return info != nullptr && info->learned != recon::Reads::kNothing;
}

bool HasOptionalCorrection(const std::string& method) {
  const recon::MethodInfo* info = recon::FindMethod(BaseMethod(method));
  return info != nullptr && info->learned == recon::Reads::kOptional;
}

std::vector<Fold> LeaveOneSubjectOut(const std::vector<RecordedPair>& pairs,
                                     const std::function<bool(const RecordedPair&)>& tested) {
  std::map<std::string, Fold> folds;
  for (const RecordedPair& pair : pairs) folds[pair.subject].name = pair.subject;
  for (auto& [subject, fold] : folds) {
    for (const RecordedPair& pair : pairs) {
      if (pair.subject != subject) {
        fold.train.push_back(&pair);
      } else if (tested(pair)) {
        fold.test.push_back(&pair);
      }
    }
  }
  const auto keys = MakeKeys(pairs);
  std::vector<Fold> list;
  for (auto& [subject, fold] : folds) {
    fold.key = ComputeKey(fold, keys);
    list.push_back(std::move(fold));
  }
  return list;
}

RecordedPair Part(const RecordedPair& pair, size_t begin, size_t end, const std::string& subject) {
  RecordedPair part{pair.clip, subject, {pair.observed.source, {}}, {pair.truth.source, {}}};
  const auto cut = [&](const recon::SkeletonSequence& from, recon::SkeletonSequence& to) {
    const size_t last = std::min(end, from.frames.size());
    for (size_t f = begin; f < last; ++f) to.frames.push_back(from.frames[f]);
  };
  cut(pair.observed, part.observed);
  cut(pair.truth, part.truth);
  return part;
}

std::vector<recon::PosturePair> CollectPairs(const std::vector<const RecordedPair*>& recordings) {
  std::vector<recon::PosturePair> pairs;
  std::map<std::string, int> groups;
  for (const RecordedPair* recorded : recordings) {
    const int group = groups.try_emplace(recorded->subject, groups.size()).first->second;
    recon::AddPairs(recorded->observed, recorded->truth, pairs, group);
  }
  return pairs;
}

recon::SkeletonSequence RunMethod(const recon::SkeletonSequence& observed,
                                  const std::string& method,
                                  const recon::ReconstructorOptions& options) {
  if (method.ends_with(kPlusPhysics)) {
    const std::string behind = method.substr(0, method.size() - kPlusPhysics.size());
    auto made = RunMethod(observed, behind, options);
    tracker::FollowMechanically(made, {});
    return made;
  }
  if (method == "raw") return observed;
  if (method == "butterworth") return recon::ButterworthSequence(observed);
  for (size_t k = 0; k < kRawLater.size(); ++k) {
    if (method == kRawLater[k]) return Delayed(observed, k + 1);
  }
  recon::ReconstructorOptions with = options;
  with.method = BaseMethod(method);
  recon::BoneLengthsById bones;
  if (method == kBestOffline) bones = recon::MeasureBones(observed, with);
  return recon::SmoothSequence(recon::ReconstructSequence(observed, with, {}, bones),
                               recon::LagOptions::Of(ParseLag(method), true));
}

MethodScore RunFolds(ExperimentContext& context, const std::string& data,
                     const std::vector<Fold>& folds, const std::string& method,
                     const recon::ReconstructorOptions& options) {
  MethodScore score;
  score.method = method;
  double milliseconds = 0.0, frames = 0.0;
  for (const Fold& fold : folds) {
    size_t observed = 0;
    for (const RecordedPair* pair : fold.test) observed += pair->observed.frames.size();
    const std::string key = fmt::format("{} {} {} {}", ComputeCodeKey(), fold.key, method,
                                        ComputeOptionsKey(context, options));
    const auto text = context.Cached(key, [&] {
      if (context.progress) context.progress(0, 0, data + " " + method + " " + fold.name);
      const FoldScore made =
          TestFold(fold, method, LearnFold(fold, method, options), context.threads);
      return nlohmann::json{{"ms", made.milliseconds}, {"clips", ClipsToJson(made.clips)}}.dump();
    });
    const auto json = nlohmann::json::parse(text);
    milliseconds += json.at("ms").get<double>();
    frames += static_cast<double>(observed);
    for (ClipMetrics& clip : ClipsFromJson(json.at("clips")))
      score.clips.push_back(std::move(clip));
  }
  score.ms_per_frame = frames > 0 ? milliseconds / frames : 0.0;
  return score;
}

}  // namespace ossa::tools
