// Gain of smoothing with later frames, by nested cross-validation: for each tested person the
// widths of the Gaussian are chosen on the other people, each evaluated without having been learned
// from (two people left out at a time), as in sdk_nested.cpp. The cut-off of a Butterworth low
// pass, common in laboratories, is chosen in the same way.
#include <fmt/format.h>

#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "recon/filters/butterworth.h"
#include "recon/filters/lag_smoothing.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"
#include "tools/experiments/simulation/jobs.h"

namespace ossa::tools {
namespace {

// Constants: by hand; they define the table.

constexpr double kFast_m_per_s = 1.0;  // faster joints show the error of smoothing
constexpr double kAllowed = 1.005;     // positions count as unchanged up to half a per cent

/// A smoothing: a low pass of the observation, or a Gaussian filter of the output of `best`.
struct Smoothing {
  recon::LagOptions lag;
  double cutoff_hz = 0.0;  // of a low pass
};

/// Smoothings among which one is chosen; the first is the reference for position errors.
struct Family {
  std::string name;
  std::vector<Smoothing> smoothings;
};

Smoothing LowPass(double cutoff_hz) { return {{.frames = 0}, cutoff_hz}; }

Family Gaussians(const std::string& name, int frames) {
  Family family{name, {{{.frames = 0}, 0.0}}};
  for (const double sigma_s : {0.03, 0.05, 0.08, 0.12}) {
    for (const double alike_m :
         {0.02, 0.05}) {  // larger values smear a jump of 40 cm by centimetres
      family.smoothings.push_back({{frames, sigma_s, alike_m, true}, 0.0});
    }
  }
  return family;
}

std::vector<Family> Families() {
  Family butterworth{"butterworth, over what was seen", {LowPass(1000.0)}};
  for (const double hz : {1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 10.0}) {
    butterworth.smoothings.push_back(LowPass(hz));
  }
  return {butterworth, Gaussians("best, one frame of lag", 1),
          Gaussians("best, two frames of lag", 2),
          Gaussians("best, whole recording", recon::kWholeRecording)};
}

/// Error, offset removed, of joints in frames in which they are fast.
struct FastError {
  double sum_cm = 0.0;
  int64_t count = 0;
};

/// Errors after smoothing.
struct SmoothingErrors {
  std::vector<ClipMetrics> clips;
  std::vector<FastError> fast;  // of each clip
};

double MeanFast_cm(const SmoothingErrors& result) {
  FastError sum;
  for (const FastError& of_clip : result.fast) {
    sum.sum_cm += of_clip.sum_cm;
    sum.count += of_clip.count;
  }
  return sum.count > 0 ? sum.sum_cm / static_cast<double>(sum.count) : 0.0;
}

FastError MeasureFastError(const PairedTracks& pair) {
  FastError fast;
  const size_t n = pair.truth.size();
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    std::vector<std::optional<Eigen::Vector3d>> error_m(n);
    Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (size_t f = 0; f < n; ++f) {
      if (!pair.truth[f].present[j] || !pair.result[f].present[j]) continue;
      error_m[f] = pair.result[f].position_m[j] - pair.truth[f].position_m[j];
      offset_m += *error_m[f], count += 1.0;
    }
    for (size_t f = 1; f < n; ++f) {
      if (!error_m[f] || !error_m[f - 1]) continue;
      const double step_s = pair.time_s[f] - pair.time_s[f - 1];
      const double moved_m = (pair.truth[f].position_m[j] - pair.truth[f - 1].position_m[j]).norm();
      if (moved_m < kFast_m_per_s * step_s) continue;
      fast.sum_cm += 100.0 * (*error_m[f] - offset_m / count).norm();
      ++fast.count;
    }
  }
  return fast;
}

recon::SkeletonSequence Smoothed(const Smoothing& smoothing, const recon::SkeletonSequence& seen,
                                 const recon::SkeletonSequence& made) {
  if (smoothing.cutoff_hz > 0.0) return recon::ButterworthSequence(seen, smoothing.cutoff_hz);
  return recon::SmoothSequence(made, smoothing.lag);
}

nlohmann::json ErrorsToJson(const std::vector<SmoothingErrors>& errors) {
  auto json = nlohmann::json::array();
  for (const SmoothingErrors& result : errors) {
    auto fast = nlohmann::json::array();
    for (const FastError& of_clip : result.fast) fast.push_back({of_clip.sum_cm, of_clip.count});
    json.push_back({ClipsToJson(result.clips), fast});
  }
  return json;
}

std::vector<SmoothingErrors> ErrorsFromJson(const nlohmann::json& json) {
  std::vector<SmoothingErrors> errors;
  for (const auto& one : json) {
    SmoothingErrors& result = errors.emplace_back();
    result.clips = ClipsFromJson(one.at(0));
    for (const auto& fast : one.at(1)) {
      result.fast.push_back({fast.at(0).get<double>(), fast.at(1).get<int64_t>()});
    }
  }
  return errors;
}

void Append(const SmoothingErrors& one, SmoothingErrors& sum) {
  sum.clips.insert(sum.clips.end(), one.clips.begin(), one.clips.end());
  sum.fast.insert(sum.fast.end(), one.fast.begin(), one.fast.end());
}

/// Errors of the smoothings over the fold's tested clips, learned without their subject. Cached.
std::vector<SmoothingErrors> EvaluateAll(ExperimentContext& context, const Fold& fold,
                                         const std::vector<Smoothing>& smoothings,
                                         const recon::ReconstructorOptions& options) {
  std::string key =
      fmt::format("lag {} {} {}", ComputeCodeKey(), fold.key, ComputeOptionsKey(context, options));
  for (const Smoothing& s : smoothings) {
    key += fmt::format(" {} {} {} {}", s.lag.frames, s.lag.sigma_s, s.lag.alike_m, s.cutoff_hz);
  }
  const std::string text = context.Cached(key, [&] {
    if (context.progress) context.progress(0, 0, "lag, without " + fold.name);
    const auto with = LearnFold(fold, "best", options);
    std::vector<std::vector<SmoothingErrors>> by_clip(fold.test.size());
    RunJobs(fold.test.size(), context.threads, [&](size_t i) {
      const RecordedPair& recorded = *fold.test[i];
      const auto made = RunMethod(recorded.observed, "best", with);
      for (const Smoothing& smoothing : smoothings) {
        SmoothingErrors& result = by_clip[i].emplace_back();
        for (const PairedTracks& pair :
             PairUp(recorded.truth, Smoothed(smoothing, recorded.observed, made))) {
          result.clips.push_back(Measure(pair));
          result.clips.back().name = recorded.clip;
          result.fast.push_back(MeasureFastError(pair));
        }
      }
    });
    std::vector<SmoothingErrors> errors(smoothings.size());
    for (const auto& of_clip : by_clip) {
      for (size_t s = 0; s < errors.size(); ++s) Append(of_clip[s], errors[s]);
    }
    return ErrorsToJson(errors).dump();
  });
  return ErrorsFromJson(nlohmann::json::parse(text));
}

/// For each person: errors of the smoothings on the other people, over every `every`-th clip.
std::map<std::string, std::vector<SmoothingErrors>> EvaluateOnOthers(
    ExperimentContext& context, const std::vector<Fold>& folds,
    const std::vector<Smoothing>& smoothings, const recon::ReconstructorOptions& options,
    size_t every) {
  std::map<std::string, std::vector<SmoothingErrors>> others;
  for (const Fold& fold : folds) others[fold.name].resize(smoothings.size());
  for (size_t a = 0; a < folds.size(); ++a) {
    for (size_t b = a + 1; b < folds.size(); ++b) {
      Fold both = WithoutBoth(folds[a], folds[b]);
      std::vector<const RecordedPair*> some;
      for (size_t i = 0; i < both.test.size(); i += every) some.push_back(both.test[i]);
      both.test = std::move(some);
      both.key += fmt::format(" every {}", every);
      const auto errors = EvaluateAll(context, both, smoothings, options);
      for (size_t s = 0; s < errors.size(); ++s) {
        for (size_t c = 0; c < errors[s].clips.size(); ++c) {
          const bool of_a = errors[s].clips[c].name.starts_with(folds[a].name + "/");
          SmoothingErrors& of_other = others[folds[of_a ? b : a].name][s];
          of_other.clips.push_back(errors[s].clips[c]);
          of_other.fast.push_back(errors[s].fast[c]);
        }
      }
    }
  }
  return others;
}

/// The smoothing with the least acceleration error among those that do not increase position
/// errors, also of fast joints; the first one if there is none.
size_t ChooseLag(const std::vector<SmoothingErrors>& errors, size_t begin, size_t end) {
  const auto of = [&](size_t s, std::optional<double> ClipMetrics::*member) {
    return Average(errors[s].clips, member).value_or(std::numeric_limits<double>::infinity());
  };
  size_t chosen = begin;
  for (size_t s = begin + 1; s < end; ++s) {
    bool unchanged = MeanFast_cm(errors[s]) <= kAllowed * MeanFast_cm(errors[begin]);
    for (const auto member :
         {&ClipMetrics::parent_relative_error_cm, &ClipMetrics::offset_removed_error_cm}) {
      unchanged = unchanged && of(s, member) <= kAllowed * of(begin, member);
    }
    const auto acceleration = &ClipMetrics::acceleration_error_cm_per_frame2;
    if (unchanged && of(s, acceleration) < of(chosen, acceleration)) chosen = s;
  }
  return chosen;
}

std::string TextOf(const Smoothing& s) {
  if (s.cutoff_hz > 0.0) return fmt::format("{:g} Hz", s.cutoff_hz);
  if (s.lag.frames == 0) return "none";
  return fmt::format("{:g} ms, {:g} cm", 1000.0 * s.lag.sigma_s, 100.0 * s.lag.alike_m);
}

std::vector<std::string> RowOf(const std::string& name, const SmoothingErrors& result,
                               double of_raw, const std::string& chosen) {
  const auto member = &ClipMetrics::acceleration_error_cm_per_frame2;
  const double change = 100.0 * (Average(result.clips, member).value_or(0.0) / of_raw - 1.0);
  return {name,
          MeanAndMedian(result.clips, &ClipMetrics::mean_joint_error_cm),
          MeanAndMedian(result.clips, &ClipMetrics::parent_relative_error_cm),
          MeanAndMedian(result.clips, &ClipMetrics::offset_removed_error_cm),
          fmt::format("{:.2f}", MeanFast_cm(result)),
          MeanAndMedian(result.clips, member),
          fmt::format("{:+.0f}", change),
          chosen};
}

/// Errors of every smoothing, and of the smoothing of each family that was chosen on other people.
struct LagStudy {
  std::vector<Smoothing> smoothings;               // of all families, one after the other
  std::vector<SmoothingErrors> fixed;              // one entry per smoothing, over all people
  std::vector<SmoothingErrors> nested;             // one per family, each person's choice
  std::vector<std::map<std::string, int>> chosen;  // one per family: people by chosen smoothing
};

LagStudy EvaluateNested(ExperimentContext& context, const std::vector<Fold>& folds,
                        const std::vector<Family>& families,
                        const recon::ReconstructorOptions& options, size_t every) {
  LagStudy study;
  for (const Family& family : families) {
    study.smoothings.insert(study.smoothings.end(), family.smoothings.begin(),
                            family.smoothings.end());
  }
  study.fixed.resize(study.smoothings.size());
  study.nested.resize(families.size());
  study.chosen.resize(families.size());
  const auto others = EvaluateOnOthers(context, folds, study.smoothings, options, every);
  for (const Fold& fold : folds) {
    const auto errors = EvaluateAll(context, fold, study.smoothings, options);
    for (size_t s = 0; s < errors.size(); ++s) Append(errors[s], study.fixed[s]);
    size_t begin = 0;
    for (size_t k = 0; k < families.size(); ++k) {
      const size_t end = begin + families[k].smoothings.size();
      const size_t best = ChooseLag(others.at(fold.name), begin, end);
      Append(errors[best], study.nested[k]);
      ++study.chosen[k][TextOf(study.smoothings[best])];
      begin = end;
    }
  }
  return study;
}

/// `full`: with a row for each smoothing, too.
std::vector<std::vector<std::string>> LagRows(const LagStudy& study,
                                              const std::vector<Family>& families, bool full) {
  const std::vector<SmoothingErrors>& fixed = study.fixed;
  const double of_raw =
      Average(fixed[0].clips, &ClipMetrics::acceleration_error_cm_per_frame2).value_or(1.0);
  std::vector<std::vector<std::string>> rows;
  size_t begin = 0;
  for (size_t k = 0; k < families.size(); ++k) {
    if (k < 2) rows.push_back(RowOf(k == 0 ? "raw" : "best, no lag", fixed[begin], of_raw, ""));
    std::string texts;
    for (const auto& [text, people] : study.chosen[k]) {
      texts += fmt::format("{}{}: {}", texts.empty() ? "" : "; ", text, people);
    }
    rows.push_back(RowOf(families[k].name, study.nested[k], of_raw, texts));
    const size_t end = begin + families[k].smoothings.size();
    for (size_t s = begin + 1; full && s < end; ++s) {
      const std::string name = families[k].name + " " + TextOf(study.smoothings[s]);
      rows.push_back(RowOf(name, fixed[s], of_raw, "fixed"));
    }
    begin = end;
  }
  return rows;
}

}  // namespace

size_t ReadLagClips(ExperimentContext& context) {
  return static_cast<size_t>(context.parameters.Integer("lag_every_nth_clip", 5, 1));
}

Table RunLag(ExperimentContext& context, const std::string& data, const std::vector<Fold>& folds,
             const recon::ReconstructorOptions& options) {
  const size_t every = ReadLagClips(context);
  const std::vector<Family> families = Families();
  const LagStudy study = EvaluateNested(context, folds, families, options, every);
  Table table;
  table.title = "Frames of lag, widths chosen on the other people, " + data;
  table.columns = {"method",      "mean error",   "eq. 18",    "offset removed",
                   "fast joints", "acceleration", "change, %", "chosen for how many people"};
  table.rows = LagRows(study, families, context.full);
  table.note = fmt::format(
      "Least acceleration error on every {}th clip of the other people, among widths that raise "
      "eq. 18, offset removed and fast joints by half a per cent at most. Fast joints: offset "
      "removed, where "
      "the true joint moves at {:g} m/s and more. Change: of acceleration against raw.",
      every, kFast_m_per_s);
  return table;
}

}  // namespace ossa::tools
