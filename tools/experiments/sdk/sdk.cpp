// Every method on every real recording; the SDK's own skeletons are the baseline. Methods that
// learn are tested on other people. Further tables on request, e.g. data = ["correct", "nested"]:
// "nested", constants of best chosen without the tested person; "lag", frames of lag;
// "incremental", incremental learning of liu-2016; "linear-bound", the best linear filter;
// "hardest", the largest errors of the last method; "reliable", without clips of unreliable truth.
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

// What can be tried, in the order in which `data` names it.
const std::vector<std::string> kRecordings = {"correct", "incorrect", "itop", "failures"};
const std::vector<std::string> kStudies = {"nested",       "lag",     "incremental",
                                           "linear-bound", "hardest", "reliable"};

std::vector<std::string> ChosenMethods(ExperimentContext& context) {
  const auto all = AllMethods();
  auto known = all;
  known.emplace_back(kBestOffline);
  known.emplace_back(kBestUnlearned);
  known.insert(known.end(), kBestLater.begin(), kBestLater.end());
  known.insert(known.end(), kRawLater.begin(), kRawLater.end());
  return context.parameters.Some("methods", known, all);
}

std::vector<std::string> ChosenData(ExperimentContext& context) {
  std::vector<std::string> known = kRecordings;
  known.insert(known.end(), kStudies.begin(), kStudies.end());
  auto chosen = context.parameters.Some("data", known, kRecordings);
  if (std::find_first_of(chosen.begin(), chosen.end(), kRecordings.begin(), kRecordings.end()) !=
      chosen.end()) {
    return chosen;
  }
  throw InputError(fmt::format("sdk: data: expected some of {} to be tried on; found {}",
                               fmt::join(kRecordings, ", "), fmt::join(chosen, ", ")));
}

/// The options but for what is read from files.
recon::ReconstructorOptions ReadMethodParameters(ExperimentContext& context) {
  recon::ReconstructorOptions options;
  options.seed = context.seed;
  const auto is_on = [&](const char* stage) {
    return context.parameters.Integer(stage, 1, 0, 1) != 0;
  };
  options.best.repair = is_on("best_repair");
  options.best.complete = is_on("best_complete");
  options.best.correct = is_on("best_correct");
  options.best.window = is_on("best_window");
  options.best.filter = is_on("best_filter");
  options.best.bones = is_on("best_bones");
  return options;
}

recon::ReconstructorOptions MakeMethodOptions(ExperimentContext& context) {
  recon::ReconstructorOptions options = ReadMethodParameters(context);
  options.database = LoadDatabase(context).postures;
  options.prior = LoadPrior(context);
  return options;
}

size_t ReadEveryNthClip(ExperimentContext& context) {
  return static_cast<size_t>(context.parameters.Integer("every_nth_clip", 1, 1));
}

class SdkStudy {
 public:
  explicit SdkStudy(ExperimentContext& context)
      : context_(context),
        methods_(ChosenMethods(context)),
        data_(ChosenData(context)),
        every_(ReadEveryNthClip(context)),
        options_(MakeMethodOptions(context)) {}

  std::vector<Table> Run() {
    RequireRecordings();
    if (IsRequested("correct") || IsRequested("incorrect")) RunUiPrmd();
    if (IsRequested("itop")) RunItop();
    if (IsRequested("linear-bound")) studies_.push_back(std::move(linear_bound_));
    if (!methods_table_.rows.empty()) {
      studies_.insert(studies_.begin(), std::move(methods_table_));
    }
    if (IsRequested("failures"))
      studies_.push_back(GrossFailureTable(context_, methods_, options_));
    return std::move(studies_);
  }

 private:
  // The last of them are read after hours.
  void RequireRecordings() const {
    std::vector<RecordingSet> wanted;
    if (IsRequested("correct") || IsRequested("incorrect")) wanted.push_back(RecordingSet::kUiPrmd);
    if (IsRequested("itop")) wanted.push_back(RecordingSet::kItop);
    if (IsRequested("failures")) {
      wanted.insert(wanted.end(), {RecordingSet::kWithoutTruth, RecordingSet::kKeraal});
    }
    tools::RequireRecordings(context_.shared, wanted);
  }

  bool IsRequested(const char* name) const {
    return std::find(data_.begin(), data_.end(), name) != data_.end();
  }

  void RunUiPrmd() {
    auto pairs = LoadUiPrmd(context_.shared, false);
    auto wrong = LoadUiPrmd(context_.shared, true);
    std::move(wrong.begin(), wrong.end(), std::back_inserter(pairs));
    for (const bool incorrect : {false, true}) {
      if (!IsRequested(incorrect ? "incorrect" : "correct")) continue;
      size_t n = 0;
      RunOn(incorrect ? "UI-PRMD incorrect" : "UI-PRMD correct",
            LeaveOneSubjectOut(pairs, [&](const RecordedPair& pair) {
              return pair.clip.ends_with("_inc") == incorrect && n++ % every_ == 0;
            }));
    }
  }

  void RunItop() {
    const auto whole = LoadItop(context_.shared).at(0);
    const size_t half = whole.observed.frames.size() / 2;
    const std::vector<RecordedPair> halves = {
        Part(whole, 0, half, "first half"),
        Part(whole, half, whole.observed.frames.size(), "second half")};
    RunOn("ITOP A2J", LeaveOneSubjectOut(halves, [](const RecordedPair&) { return true; }));
  }

  void RunOn(const std::string& data, const std::vector<Fold>& folds) {
    if (IsRequested("linear-bound")) AddLinearBound(data, folds, &linear_bound_);
    if (folds.size() > 2) RunStudiesOfFolds(data, folds);
    std::vector<MethodScore> scores;
    for (const std::string& method : methods_) {
      scores.push_back(RunFolds(context_, data, folds, method, options_));
      methods_table_.rows.push_back(MethodRow(data, scores.back()));
    }
    if (!data.starts_with("UI-PRMD")) return;
    if (IsRequested("hardest")) studies_.push_back(HardestTable(data, scores));
    if (IsRequested("reliable")) studies_.push_back(ReliableClipsTable(data, scores));
  }

  // Those that leave subjects out within what is left: two folds are too few.
  void RunStudiesOfFolds(const std::string& data, const std::vector<Fold>& folds) {
    if (IsRequested("nested")) {
      studies_.push_back(RunNested(context_, data, folds, options_, &methods_table_));
    }
    if (IsRequested("lag")) studies_.push_back(RunLag(context_, data, folds, options_));
    if (IsRequested("incremental")) studies_.push_back(RunIncremental(context_, folds, options_));
  }

  ExperimentContext& context_;
  std::vector<std::string> methods_;
  std::vector<std::string> data_;
  size_t every_;
  recon::ReconstructorOptions options_;
  Table methods_table_ = EmptyTable();
  Table linear_bound_ = EmptyLinearBound();
  std::vector<Table> studies_;
};

}  // namespace

void ReadSdkParameters(ExperimentContext& context) {
  ChosenMethods(context);
  ChosenData(context);
  ReadEveryNthClip(context);
  ReadLagClips(context);
  ReadMethodParameters(context);
  ReadUsesPrior(context.parameters);
}

std::vector<Table> RunSdk(ExperimentContext& context) { return SdkStudy(context).Run(); }

}  // namespace ossa::tools
