// A comparison as JSON and as tables for a terminal.
#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "depth/base/one_line.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/experiment.h"
#include "tools/json/json_text.h"

namespace ossa::tools {
namespace {

using Json = nlohmann::ordered_json;

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json ByJoint(const recon::JointArray<std::optional<double>>& values) {
  Json json = Json::object();
  for (size_t j = 0; j < values.size(); ++j) {
    if (values[j]) json[std::string(recon::kJointNames[j])] = *values[j];
  }
  return json;
}

Json JsonOf(const ClipMetrics& m) {
  return {{"name", m.name},
          {"frames", m.frames},
          {"mean_joint_error_cm", OrNull(m.mean_joint_error_cm)},
          {"parent_relative_error_cm", OrNull(m.parent_relative_error_cm)},
          {"fraction_frames_over_20cm", OrNull(m.fraction_frames_over_20cm)},
          {"fraction_joints_within_10cm", OrNull(m.fraction_joints_within_10cm)},
          {"acceleration_error_cm_per_frame2", OrNull(m.acceleration_error_cm_per_frame2)},
          {"per_joint_cm", ByJoint(m.per_joint_cm)},
          {"map_10cm", OrNull(m.map_10cm)},
          {"ap_10cm", ByJoint(m.ap_10cm)},
          {"offset_removed_error_cm", OrNull(m.offset_removed_error_cm)},
          {"bone_length_variation_percent", OrNull(m.bone_length_variation_percent)},
          {"p95_cm", OrNull(m.p95_cm)},
          {"p99_cm", OrNull(m.p99_cm)},
          {"fraction_joints_missing", OrNull(m.fraction_joints_missing)},
          {"time_offset_s", m.offset_s},
          {"frame_times_agree", m.same_clock}};
}

Json JsonOf(const std::optional<Interval>& interval) {
  if (!interval) return nullptr;
  return {interval->low, interval->high};
}

Json JsonOf(const ComparedResult& result) {
  Json json = JsonOf(result.mean);
  json["confidence_95"] = {
      {"mean_joint_error_cm", JsonOf(result.mean_joint_error_interval)},
      {"parent_relative_error_cm", JsonOf(result.parent_relative_error_interval)}};
  json["missing_clips"] = result.missing_clips;
  json["clips"] = Json::array();
  for (const ClipMetrics& clip : result.clips) json["clips"].push_back(JsonOf(clip));
  return json;
}

std::string Number(const std::optional<double>& value, int digits = 2, double scale = 1) {
  return value ? fmt::format("{:.{}f}", scale * *value, digits) : "-";
}

std::string WithInterval(const std::optional<double>& value,
                         const std::optional<Interval>& interval) {
  if (!interval) return Number(value);
  return fmt::format("{} [{:.2f}, {:.2f}]", Number(value), interval->low, interval->high);
}

// A row of the summary: its name and its cell for one result.
struct SummaryRow {
  const char* name;
  std::string (*cell)(const ComparedResult&);
};

std::string OffsetCell(const ComparedResult& r) {
  return r.mean.same_clock ? "0 (times agree)" : fmt::format("{:+.3f}", r.mean.offset_s);
}

using OfResult = const ComparedResult&;
constexpr std::array kSummary = {
    SummaryRow{"clips", [](OfResult r) { return std::to_string(r.clips.size()); }},
    SummaryRow{"frames", [](OfResult r) { return std::to_string(r.mean.frames); }},
    SummaryRow{"mean error cm",
               [](OfResult r) {
                 return WithInterval(r.mean.mean_joint_error_cm, r.mean_joint_error_interval);
               }},
    SummaryRow{"eq. 18 cm",
               [](OfResult r) {
                 return WithInterval(r.mean.parent_relative_error_cm,
                                     r.parent_relative_error_interval);
               }},
    SummaryRow{"frames >20cm %",
               [](OfResult r) { return Number(r.mean.fraction_frames_over_20cm, 1, 100); }},
    SummaryRow{"joints missing %",
               [](OfResult r) { return Number(r.mean.fraction_joints_missing, 1, 100); }},
    SummaryRow{"joints <10cm %",
               [](OfResult r) { return Number(r.mean.fraction_joints_within_10cm, 1, 100); }},
    SummaryRow{"mAP 10cm %", [](OfResult r) { return Number(r.mean.map_10cm, 1, 100); }},
    SummaryRow{"acceleration error cm/frame^2",
               [](OfResult r) { return Number(r.mean.acceleration_error_cm_per_frame2); }},
    SummaryRow{"offset-free cm", [](OfResult r) { return Number(r.mean.offset_removed_error_cm); }},
    SummaryRow{"bone length variation %",
               [](OfResult r) { return Number(r.mean.bone_length_variation_percent); }},
    SummaryRow{"p99 cm", [](OfResult r) { return Number(r.mean.p99_cm, 1); }},
    SummaryRow{"time offset s", OffsetCell},
};

std::string MakeNote(const Comparison& comparison) {
  std::string note;
  for (const ComparedResult& r : comparison.results) {
    if (r.missing_clips.empty()) continue;
    note += fmt::format("{} lacks {} of the truth's clips, e.g. {}. ", r.label,
                        r.missing_clips.size(), r.missing_clips[0]);
  }
  return note +
         "Over several clips: the mean of the clips' numbers, with its 95 % bootstrap interval. "
         "eq. 18: joints relative to their parents (Shum 2013). Offset-free: each joint's constant "
         "offset taken away.";
}

Table SummaryTable(const Comparison& comparison) {
  Table table;
  table.title = fmt::format("Against {} ({}{})", comparison.truth,
                            comparison.rigid ? "one rigid transform a clip" : "no alignment",
                            comparison.found_only ? ", joints found only" : "");
  table.columns = {""};
  for (const ComparedResult& r : comparison.results) table.columns.push_back(r.label);
  for (const SummaryRow& row : kSummary) {
    table.rows.push_back({row.name});
    for (const ComparedResult& r : comparison.results) table.rows.back().push_back(row.cell(r));
  }
  table.note = MakeNote(comparison);
  return table;
}

Table JointTable(const Comparison& comparison) {
  Table table;
  table.title = "Mean error by joint, cm";
  table.columns = {"joint"};
  for (const ComparedResult& result : comparison.results) table.columns.push_back(result.label);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    std::vector<std::string> row = {std::string(recon::kJointNames[j])};
    bool any = false;
    for (const ComparedResult& result : comparison.results) {
      row.push_back(Number(result.mean.per_joint_cm[j]));
      any = any || result.mean.per_joint_cm[j];
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

Table TestTable(const Comparison& comparison) {
  Table table;
  table.title = "Paired tests over clips (Plantard 2016, section 8.2)";
  table.columns = {"quantity", "test", "between", "clips", "statistic", "p", "p (Bonferroni)"};
  for (const ComparedTest& test : comparison.tests) {
    table.rows.push_back({test.quantity, test.test, test.between, std::to_string(test.units),
                          fmt::format("{:.4g}", test.result.statistic),
                          fmt::format("{:.3g}", test.result.p),
                          fmt::format("{:.3g}", test.corrected_p)});
  }
  return table;
}

}  // namespace

std::string ToJson(const Comparison& comparison) {
  Json json = {{"truth", comparison.truth},
               {"align", comparison.rigid ? "rigid" : "none"},
               {"joints", comparison.found_only ? "found" : "all"},
               {"results", Json::array()},
               {"tests", Json::array()}};
  for (const ComparedResult& result : comparison.results) {
    json["results"].push_back(JsonOf(result));
  }
  for (const ComparedTest& test : comparison.tests) {
    json["tests"].push_back({{"test", test.test},
                             {"quantity", test.quantity},
                             {"between", test.between},
                             {"clips", test.units},
                             {"statistic", test.result.statistic},
                             {"p", test.result.p},
                             {"p_bonferroni", test.corrected_p}});
  }
  return JsonText(json) + "\n";
}

std::string ToText(const Comparison& comparison) {
  std::string text = ToMarkdown(SummaryTable(comparison)) + "\n";
  text += ToMarkdown(JointTable(comparison));
  if (!comparison.tests.empty()) text += "\n" + ToMarkdown(TestTable(comparison));
  if (const std::string advice = MakeAdvice(comparison); !advice.empty())
    text += "\n" + OnOneLine(advice) + "\n";
  return text;
}

}  // namespace ossa::tools
