// Every method on every real recording; the SDK's own skeletons are the baseline. Whatever learns
// has never seen the people it is tested on. More tables when asked for: data = ["correct",
// "nested"], constants of best chosen without the person tested; "lag", frames of lag;
// "incremental", liu-2016 while it learns; "linear-bound", the best that any filter of fixed
// weights does; "hardest", where the last of the methods is farthest off; "honest", without
// what says little of a sensor.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "depth/base/error.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"

namespace ossa::tools {
namespace {

std::vector<std::string> AllMethods() {
  std::vector<std::string> methods = {"raw", "butterworth"};
  for (const std::string& name : recon::ReconstructionMethods()) methods.push_back(name);
  for (const char* name : {"raw", "shum-ho-2012", "shum-2013", "plantard-2016", "best"}) {
    methods.push_back(std::string(name).append(kPlusPhysics));
  }
  return methods;
}

}  // namespace

std::vector<std::string> MethodRow(const std::string& data, const MethodScore& score) {
  const auto both = [&](std::optional<double> ClipMetrics::*member) {
    return MeanAndMedian(score.clips, member);
  };
  int64_t frames = 0;
  for (const ClipMetrics& clip : score.clips) frames += clip.frames;
  return {data,
          score.method,
          std::to_string(score.clips.size()),
          std::to_string(frames),
          both(&ClipMetrics::mean_joint_error_cm),
          both(&ClipMetrics::parent_relative_error_cm),
          both(&ClipMetrics::offset_removed_error_cm),
          both(&ClipMetrics::acceleration_error_cm_per_frame2),
          Cell(Average(score.clips, &ClipMetrics::p99_cm), 1),
          Cell(Average(score.clips, &ClipMetrics::bone_length_variation_percent)),
          fmt::format("{:.2f}", score.ms_per_frame)};
}

namespace {

Table EmptyTable() {
  Table table;
  table.title = "Methods on real recordings (cm: mean over clips, median in brackets)";
  table.columns = {"data",           "method",       "clips", "frames",   "mean error", "eq. 18",
                   "offset removed", "acceleration", "p99",   "bones, %", "ms/frame"};
  table.note =
      "UI-PRMD: leave one subject out; ITOP: learned on one half, tested on the other, both ways "
      "(one of its people is in both, by a hundred frames). ms: processor time, of the run that "
      "the cache keeps. "
      "butterworth looks into the future and is here for comparison only; so does best-offline, "
      "best with the bones of the whole recording, smoothed; best-lag-N knows N frames more. "
      "+physics: the physical character follows. "
      "Bones: standard deviation of a bone's length "
      "over the clip.";
  return table;
}

}  // namespace

std::vector<Table> RunSdk(ExperimentContext& context) {
  Table table = EmptyTable();
  const auto all = AllMethods();
  auto known_methods = all;
  known_methods.emplace_back(kBestOffline);
  known_methods.emplace_back(kBestUnlearned);
  known_methods.insert(known_methods.end(), kBestLater.begin(), kBestLater.end());
  known_methods.insert(known_methods.end(), kRawLater.begin(), kRawLater.end());
  const auto methods = context.parameters.Some("methods", known_methods, all);
  const std::vector<std::string> recordings = {"correct", "incorrect", "itop", "failures"};
  std::vector<std::string> known = recordings;
  known.insert(known.end(), {"nested", "lag", "incremental", "linear-bound", "hardest", "honest"});
  const auto sets = context.parameters.Some("data", known, recordings);
  const auto wanted = [&](const std::string& name) {
    return std::find(sets.begin(), sets.end(), name) != sets.end();
  };
  if (std::none_of(recordings.begin(), recordings.end(), wanted)) {
    throw InputError(fmt::format("sdk: data: expected some of {} to be tried on; found {}",
                                 fmt::join(recordings, ", "), fmt::join(sets, ", ")));
  }
  const int every = context.parameters.Integer("every_nth_clip", 1, 1);
  recon::ReconstructorOptions options;
  options.seed = context.seed;
  options.database = LoadDatabase(context).postures;
  options.prior = LoadPrior(context);
  options.best.repair = context.parameters.Integer("best_repair", 1) != 0;
  options.best.complete = context.parameters.Integer("best_complete", 1) != 0;
  options.best.correct = context.parameters.Integer("best_correct", 1) != 0;
  options.best.window = context.parameters.Integer("best_window", 1) != 0;
  options.best.filter = context.parameters.Integer("best_filter", 1) != 0;
  options.best.bones = context.parameters.Integer("best_bones", 1) != 0;
  std::vector<Table> tables;
  Table linear = EmptyLinearBound();
  const bool bound = wanted("linear-bound");
  const auto run = [&](const std::string& data, const std::vector<Fold>& folds) {
    if (bound) AddLinearBound(data, folds, &linear);
    if (wanted("nested") && folds.size() > 2)
      tables.push_back(RunNested(context, data, folds, options, &table));
    if (wanted("lag") && folds.size() > 2) tables.push_back(RunLag(context, data, folds, options));
    if (wanted("incremental") && folds.size() > 2)
      tables.push_back(RunIncremental(context, folds, options));
    std::vector<MethodScore> scores;
    for (const std::string& method : methods) {
      scores.push_back(RunFolds(context, data, folds, method, options));
      table.rows.push_back(MethodRow(data, scores.back()));
    }
    if (wanted("hardest") && data.starts_with("UI-PRMD"))
      tables.push_back(HardestTable(data, scores));
    if (wanted("honest") && data.starts_with("UI-PRMD"))
      tables.push_back(HonestTable(data, scores));
  };
  if (wanted("correct") || wanted("incorrect")) {
    auto pairs = LoadUiPrmd(context.shared, false);
    auto wrong = LoadUiPrmd(context.shared, true);
    std::move(wrong.begin(), wrong.end(), std::back_inserter(pairs));
    for (const bool incorrect : {false, true}) {
      if (!wanted(incorrect ? "incorrect" : "correct")) continue;
      size_t n = 0;
      run(incorrect ? "UI-PRMD incorrect" : "UI-PRMD correct",
          LeaveOneSubjectOut(pairs, [&](const RecordedPair& pair) {
            return pair.clip.ends_with("_inc") == incorrect &&
                   n++ % static_cast<size_t>(every) == 0;
          }));
    }
  }
  if (wanted("itop")) {
    const auto whole = LoadItop(context.shared).at(0);
    const size_t half = whole.observed.frames.size() / 2;
    const std::vector<RecordedPair> halves = {
        Part(whole, 0, half, "first half"),
        Part(whole, half, whole.observed.frames.size(), "second half")};
    run("ITOP A2J", LeaveOneSubjectOut(halves, [](const RecordedPair&) { return true; }));
  }
  if (bound) tables.push_back(std::move(linear));
  if (!table.rows.empty()) tables.insert(tables.begin(), std::move(table));
  if (wanted("failures")) tables.push_back(GrossFailureTable(context, methods, options));
  return tables;
}

}  // namespace ossa::tools
