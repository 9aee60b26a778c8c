// Were the constants of `best` fitted to the people they are tested on? For each person left out
// the constants are chosen on the others, the correction learned without the one that it is tried
// on (two people left out at a time), and only then is the person reconstructed. What a row of
// fixed constants has over this one is what their choice has seen.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/experiments/sdk/method_runs.h"
#include "tools/experiments/sdk/sdk_internal.h"

namespace ossa::tools {

Fold WithoutBoth(const Fold& a, const Fold& b) {
  Fold both{a.name + " " + b.name, {}, a.test, "without " + a.key + " " + b.key};
  both.test.insert(both.test.end(), b.test.begin(), b.test.end());
  for (const RecordedPair* recorded : a.train) {
    if (recorded->subject != b.name) both.train.push_back(recorded);
  }
  return both;
}

namespace {

struct Choice {
  const char* name;
  double recon::BestConstants::*member;
  std::vector<double> values;
};

// Apart by factors of about two, the shipped constant among them.
const std::vector<Choice>& Choices() {
  using Constants = recon::BestConstants;
  static const std::vector<Choice> choices = {
      {"acceleration, m/s^2", &Constants::acceleration, {5.0, 10.0, 20.0}},
      {"of posture", &Constants::posture_share, {0.3, 0.6, 1.0}},
      {"outwards", &Constants::limb_firmness, {0.25, 0.5, 1.0}},
      {"expected", &Constants::expected_share, {0.1, 0.3, 0.6}},
      {"slack, m", &Constants::failure_slack_m, {0.06, 0.12, 0.24}}};
  return choices;
}

/// The fixed constants first, then one changed at a time.
std::vector<recon::BestConstants> SettingsAround(const recon::BestConstants& fixed) {
  std::vector<recon::BestConstants> settings = {fixed};
  for (const Choice& choice : Choices()) {
    for (const double value : choice.values) {
      if (value == fixed.*choice.member) continue;
      settings.push_back(fixed);
      settings.back().*choice.member = value;
    }
  }
  return settings;
}

using ClipsBySetting = std::vector<std::vector<ClipMetrics>>;

/// All settings over the tested clips, one correction for them all. Cached.
ClipsBySetting EvaluateAll(ExperimentContext& context, const Fold& fold,
                           const std::vector<recon::BestConstants>& settings,
                           const recon::ReconstructorOptions& options) {
  std::string key = fmt::format("nested {} {} {}", ComputeCodeKey(), fold.key,
                                ComputeOptionsKey(context, options));
  for (const auto& setting : settings) key.append(" ").append(DescribeConstants(setting));
  const std::string text = context.Cached(key, [&] {
    if (context.progress) context.progress(0, 0, "nested, without " + fold.name);
    recon::ReconstructorOptions with = LearnFold(fold, "best", options);
    auto json = nlohmann::json::array();
    for (const auto& setting : settings) {
      with.best.constants = setting;
      json.push_back(ClipsToJson(TestFold(fold, "best", with, context.threads).clips));
    }
    return json.dump();
  });
  ClipsBySetting clips;
  for (const auto& of_setting : nlohmann::json::parse(text)) {
    clips.push_back(ClipsFromJson(of_setting));
  }
  return clips;
}

/// Of each fold: what the settings make of the other people.
std::map<std::string, ClipsBySetting> EvaluateOnOthers(
    ExperimentContext& context, const std::vector<Fold>& folds,
    const std::vector<recon::BestConstants>& settings, const recon::ReconstructorOptions& options) {
  std::map<std::string, ClipsBySetting> others;
  for (const Fold& fold : folds) others[fold.name].resize(settings.size());
  for (size_t a = 0; a < folds.size(); ++a) {
    for (size_t b = a + 1; b < folds.size(); ++b) {
      const auto clips = EvaluateAll(context, WithoutBoth(folds[a], folds[b]), settings, options);
      for (size_t s = 0; s < settings.size(); ++s) {
        for (const ClipMetrics& clip : clips[s]) {
          const bool of_a = clip.name.starts_with(folds[a].name + "/");
          others[folds[of_a ? b : a].name][s].push_back(clip);
        }
      }
    }
  }
  return others;
}

/// The three errors of the table as one number without a unit: the logarithm of their product.
double ComputeLogError(const std::vector<ClipMetrics>& clips) {
  double sum = 0.0;
  for (const auto member :
       {&ClipMetrics::parent_relative_error_cm, &ClipMetrics::offset_removed_error_cm,
        &ClipMetrics::acceleration_error_cm_per_frame2}) {
    sum += std::log(Average(clips, member).value_or(1.0));
  }
  return sum;
}

/// Each constant by itself; ties go to the fixed one.
recon::BestConstants ChosenOn(const ClipsBySetting& clips,
                              const std::vector<recon::BestConstants>& settings) {
  recon::BestConstants chosen = settings[0];
  for (const Choice& choice : Choices()) {
    double least = ComputeLogError(clips[0]);
    for (size_t s = 1; s < settings.size(); ++s) {
      if (settings[s].*choice.member == settings[0].*choice.member) continue;
      if (const double badness = ComputeLogError(clips[s]); badness < least) {
        least = badness;
        chosen.*choice.member = settings[s].*choice.member;
      }
    }
  }
  return chosen;
}

}  // namespace

Table RunNested(ExperimentContext& context, const std::string& data, const std::vector<Fold>& folds,
                const recon::ReconstructorOptions& options, Table* methods) {
  const auto settings = SettingsAround(options.best.constants);
  const auto others = EvaluateOnOthers(context, folds, settings, options);
  Table table;
  table.title = "Constants of best chosen on the other people, " + data;
  table.columns = {"left out"};
  for (const Choice& choice : Choices()) table.columns.push_back(choice.name);
  table.columns.insert(table.columns.end(), {"eq. 18", "with the fixed ones"});
  MethodScore all{"best, nested", {}, 0.0};
  for (const Fold& fold : folds) {
    recon::ReconstructorOptions with = options;
    const auto fixed = RunFolds(context, data, {fold}, "best", with);
    with.best.constants = ChosenOn(others.at(fold.name), settings);
    const auto nested = RunFolds(context, data, {fold}, "best", with);
    all.clips.insert(all.clips.end(), nested.clips.begin(), nested.clips.end());
    all.ms_per_frame += nested.ms_per_frame / static_cast<double>(folds.size());
    std::vector<std::string> row = {fold.name};
    for (const Choice& choice : Choices()) {
      row.push_back(fmt::format("{:g}", with.best.constants.*choice.member));
    }
    for (const auto& score : {nested, fixed}) {
      row.push_back(Cell(Average(score.clips, &ClipMetrics::parent_relative_error_cm)));
    }
    table.rows.push_back(std::move(row));
  }
  methods->rows.push_back(MethodRow(data, all));
  table.note =
      "Each constant is the one of three with the least product of eq. 18, offset removed and "
      "acceleration on the other people, the correction learned without them in turn.";
  return table;
}

}  // namespace ossa::tools
