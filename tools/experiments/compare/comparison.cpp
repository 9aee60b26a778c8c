#include "tools/experiments/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "depth/base/error.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {
namespace {

using recon::SkeletonClip;

bool HoldsAny(const std::string& name, const std::vector<std::string>& parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const std::string& part) { return name.find(part) != std::string::npos; });
}

void ThrowIfInterrupted(const CompareOptions& options) {
  if (options.stop && options.stop()) throw Interruption{};
}

/// `columns`: the default choice for files that contain truth and estimate.
std::vector<SkeletonClip> Chosen(const std::string& path, const CompareOptions& options,
                                 const char* columns, std::vector<std::string>& warnings) {
  auto reading = options.reading;
  if (reading.columns.empty()) reading.columns = columns;
  reading.stop = options.stop;
  auto clips = recon::ReadSkeletonClips(path, reading);
  ThrowIfInterrupted(options);
  std::erase_if(clips, [&](const SkeletonClip& clip) {
    return HoldsAny(clip.name, options.skip) ||
           (!options.only.empty() && !HoldsAny(clip.name, options.only));
  });
  if (clips.empty()) throw InputError(path + ": no clip is left by --only and --skip");
  for (const SkeletonClip& clip : clips) {
    warnings.insert(warnings.end(), clip.sequence.warnings.begin(), clip.sequence.warnings.end());
  }
  return clips;
}

// If nothing can be compared, an error lists the clips found.
[[noreturn]] void RefuseEmpty(const std::string& truth, const std::string& result,
                              const std::string& what) {
  throw InputError(fmt::format("{}: expected {} of {}, found none", result, what, truth));
}

void AddClip(ComparedResult& compared, const std::string& name, const SkeletonClip& truth,
             const SkeletonClip& result, const PairOptions& options) {
  for (PairedTracks& pair : PairUp(truth.sequence, result.sequence, options)) {
    pair.name = name.empty() || pair.name.empty() ? name + pair.name : name + " " + pair.name;
    ClipMetrics metrics = Measure(pair);
    if (metrics.frames == 0 && !metrics.fraction_joints_missing) continue;
    compared.clips.push_back(std::move(metrics));
    compared.pairs.push_back(std::move(pair));
  }
}

// A line about clips without a counterpart. Names are case-sensitive.
void WarnOfClipsWithoutTruth(const std::vector<SkeletonClip>& truth, const std::string& truth_name,
                             const std::vector<SkeletonClip>& results, const std::string& name,
                             std::vector<std::string>& warnings) {
  std::set<std::string> known;
  for (const SkeletonClip& clip : truth) known.insert(clip.name);
  std::vector<std::string> others;
  for (const SkeletonClip& clip : results) {
    if (!known.contains(clip.name)) others.push_back(clip.name);
  }
  if (others.empty()) return;
  warnings.push_back(
      fmt::format("{}: {} of its {} clips have no truth of their name in {}, e.g. {}", name,
                  others.size(), results.size(), truth_name, others.front()));
}

ComparedResult CompareOne(const std::string& truth_name, const std::vector<SkeletonClip>& truth,
                          const std::string& name, const CompareOptions& options,
                          const std::function<void()>& on_clip,
                          std::vector<std::string>& warnings) {
  ComparedResult compared;
  compared.name = name;
  const auto results = Chosen(name, options, "observed", warnings);
  std::map<std::string, const SkeletonClip*> by_name;
  for (const SkeletonClip& clip : results) by_name[clip.name] = &clip;
  const bool single = truth.size() == 1 && results.size() == 1;
  for (const SkeletonClip& clip : truth) {
    on_clip();
    const auto found = by_name.find(clip.name);
    if (!single && found == by_name.end()) {
      compared.missing_clips.push_back(clip.name);
      continue;
    }
    ThrowIfInterrupted(options);
    PairOptions pairing = options.pairing;
    pairing.stop = options.stop;
    AddClip(compared, clip.name, clip, single ? results[0] : *found->second, pairing);
  }
  if (compared.missing_clips.size() == truth.size()) {
    RefuseEmpty(truth_name, name, "clips with the names of those");
  }
  if (!single) WarnOfClipsWithoutTruth(truth, truth_name, results, name, warnings);
  compared.mean = MeanOverClips(name, compared.clips);
  // A result without people counts, too: every joint is missed.
  if (compared.clips.empty()) RefuseEmpty(truth_name, name, "frames at the times");
  compared.mean_joint_error_interval =
      BootstrapMean(Values(compared.clips, &ClipMetrics::mean_joint_error_cm), options.seed);
  compared.parent_relative_error_interval =
      BootstrapMean(Values(compared.clips, &ClipMetrics::parent_relative_error_cm), options.seed);
  return compared;
}

void AddTest(std::vector<ComparedTest>& tests, const std::string& test, const std::string& quantity,
             const std::string& between, size_t units, const std::optional<TestResult>& result,
             double corrections) {
  if (!result) return;
  tests.push_back(
      {test, quantity, between, units, *result, std::min(1.0, corrections * result->p)});
}

// Plantard 2016, 8.2: normal errors by repeated-measures Anova and Bonferroni, the others by
// Friedman and Wilcoxon signed rank with Bonferroni. Both families are reported for both
// quantities; the normality test says which to believe.
void TestQuantity(const std::vector<ComparedResult>& results, const std::string& quantity,
                  std::optional<double> ClipMetrics::*member, std::vector<ComparedTest>& tests) {
  std::vector<std::vector<ClipMetrics>> clips;
  for (const ComparedResult& result : results) clips.push_back(result.clips);
  const auto values = SharedValues(clips, member);
  // With fewer pairs no signed-rank test can reach p = 0.05; by definition: 2^-4 = 0.0625
  constexpr size_t kFewestUnits = 5;
  const size_t units = values[0].size();
  if (units < kFewestUnits) return;
  for (size_t r = 0; r < results.size(); ++r) {
    AddTest(tests, "Lilliefors normality", quantity, results[r].label, units, Lilliefors(values[r]),
            1);
  }
  AddTest(tests, "repeated-measures Anova", quantity, "all", units, RepeatedAnova(values), 1);
  AddTest(tests, "Friedman", quantity, "all", units, Friedman(values), 1);
  const auto pairs = static_cast<double>(results.size() * (results.size() - 1) / 2);
  for (size_t a = 0; a < results.size(); ++a) {
    for (size_t b = a + 1; b < results.size(); ++b) {
      const std::string between = results[a].label + " / " + results[b].label;
      AddTest(tests, "paired t", quantity, between, units, PairedT(values[a], values[b]), pairs);
      AddTest(tests, "Wilcoxon signed rank", quantity, between, units,
              Wilcoxon(values[a], values[b]), pairs);
    }
  }
}

void Label(std::vector<ComparedResult>& results) {
  std::map<std::string, int> uses;
  const auto last_part = [](const std::string& name) {
    return name.substr(name.find_last_of('/') + 1);
  };
  for (const ComparedResult& result : results) ++uses[last_part(result.name)];
  for (ComparedResult& result : results) {
    const std::string part = last_part(result.name);
    result.label = part.empty() || uses[part] > 1 ? result.name : part;
  }
}

}  // namespace

Comparison Compare(const std::string& truth, const std::vector<std::string>& results,
                   const CompareOptions& options) {
  Comparison comparison;
  comparison.truth = truth;
  comparison.rigid = options.pairing.rigid;
  comparison.found_only = options.pairing.found_only;
  const auto clips = Chosen(truth, options, "truth", comparison.warnings);
  size_t begun = 0;
  const auto on_clip = [&] {
    if (options.progress) options.progress(begun, clips.size() * results.size());
    ++begun;
  };
  for (const std::string& result : results) {
    comparison.results.push_back(
        CompareOne(truth, clips, result, options, on_clip, comparison.warnings));
  }
  Label(comparison.results);
  if (results.size() > 1) {
    TestQuantity(comparison.results, "mean joint error", &ClipMetrics::mean_joint_error_cm,
                 comparison.tests);
    TestQuantity(comparison.results, "parent-relative error",
                 &ClipMetrics::parent_relative_error_cm, comparison.tests);
    TestQuantity(comparison.results, "share of frames over 20 cm",
                 &ClipMetrics::fraction_frames_over_20cm, comparison.tests);
  }
  return comparison;
}

}  // namespace ossa::tools
