#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string_view>

#include "recon/body/parts.h"
#include "recon/skeleton.h"
#include "tools/experiments/compare/svg_plot.h"
#include "tools/json/base64.h"
#include "tools/learning/common_parts.h"
#include "tools/learning/evaluate.h"

namespace ossa::tools {
namespace {

// JSON has no NaN: what does not occur is left out.
template <typename Names>
nlohmann::ordered_json ByName(const std::vector<double>& values, const Names& names, size_t first) {
  nlohmann::ordered_json object = nlohmann::ordered_json::object();
  for (size_t i = first; i < values.size(); ++i) {
    if (std::isfinite(values[i])) object[std::string(names[i])] = values[i];
  }
  return object;
}

nlohmann::ordered_json Number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json CalibrationJson(const Calibration& calibration) {
  nlohmann::ordered_json json;
  json["calibration_error"] = Number(calibration.ExpectedError());
  json["tenths"] = nlohmann::ordered_json::array();
  for (const Calibration::Bin& bin : calibration.Bins()) {
    if (bin.joints == 0) continue;
    const double within = static_cast<double>(bin.hits) / static_cast<double>(bin.joints);
    json["tenths"].push_back({{"joints", bin.joints},
                              {"mean_confidence", bin.mean_confidence},
                              {"within_10cm", within}});
  }
  return json;
}

// For reading: `scale` times the value, a dash where there is none.
std::string Shown(double value, double scale, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", scale * value, digits) : "–";
}

std::string CalibrationTable(const std::string& heading, const Calibration& calibration) {
  std::string html = fmt::format(
      "<h2>{}</h2>\n<table>\n<tr><th>joints</th><th>confidence, %</th><th>within 10 cm, "
      "%</th></tr>\n",
      heading);
  for (const Calibration::Bin& bin : calibration.Bins()) {
    if (bin.joints == 0) continue;
    html += fmt::format("<tr><td>{}</td><td>{:.1f}</td><td>{:.1f}</td></tr>\n", bin.joints,
                        100 * bin.mean_confidence,
                        100.0 * static_cast<double>(bin.hits) / static_cast<double>(bin.joints));
  }
  return html + "</table>\n";
}

// A calibrated confidence lies on the diagonal.
std::string CalibrationPlot(const Evaluation& e) {
  std::vector<Series> lines = {{"as often right as it says", {0, 100}, {0.0, 100.0}}};
  const auto add = [&](const char* name, const Calibration& calibration) {
    Series line{name, {}, {}};
    for (const Calibration::Bin& bin : calibration.Bins()) {
      if (bin.joints == 0) continue;
      line.x.push_back(100 * bin.mean_confidence);
      line.y.emplace_back(100.0 * static_cast<double>(bin.hits) / static_cast<double>(bin.joints));
    }
    if (!line.x.empty()) lines.push_back(std::move(line));
  };
  add("joints that are seen", e.seen_joints);
  add("joints that are inferred", e.inferred_joints);
  return "<h2>How far a confidence is to be trusted</h2>\n" +
         LinePlot(lines, {"confidence, %", "within 10 cm, %", 100.0, 100.0});
}

// A row a true part, a column the model's: the darker, the larger the share of the row.
std::string ConfusionMatrix(const std::vector<std::vector<int64_t>>& confusion) {
  std::string html = "<h2>Which part is taken for which</h2>\n<table class=\"confusion\">\n";
  for (size_t truth = 1; truth < confusion.size(); ++truth) {
    const auto& row = confusion[truth];
    const auto all = static_cast<double>(std::accumulate(row.begin(), row.end(), int64_t{0}));
    if (all == 0) continue;
    html += fmt::format("<tr><th>{}</th>", recon::kPartNames[truth]);
    for (size_t label = 1; label < row.size(); ++label) {
      const double share = static_cast<double>(row[label]) / all;
      html += fmt::format(
          "<td style=\"background:rgba(58,124,165,{:.3f})\" title=\"{} as {}: {:.1f} %\"></td>",
          share, recon::kPartNames[truth], recon::kPartNames[label], 100 * share);
    }
    html += "</tr>\n";
  }
  return html +
         "</table>\n<p>Columns: the parts in their order, also those of which no pixel is true. "
         "Cells say their names.</p>\n";
}

std::string WorstFrames(const std::vector<Evaluation::Frame>& frames) {
  if (frames.empty()) return {};
  std::string html = "<h2>Worst frames: depth, true parts, the model's</h2>\n";
  for (const Evaluation::Frame& frame : frames) {
    const std::string_view bytes(reinterpret_cast<const char*>(frame.png.data()), frame.png.size());
    html += fmt::format(
        "<figure><img alt=\"frame {0}\" src=\"data:image/png;base64,{1}\"><figcaption>frame {0}: "
        "{2:.1f} % "
        "of its pixels right</figcaption></figure>\n",
        frame.index, Base64(bytes), 100 * frame.pixel_accuracy);
  }
  return html;
}

template <typename Names>
std::string Bars(const std::string& heading, const std::vector<double>& values, const Names& names,
                 size_t first) {
  std::string html = fmt::format("<h2>{}</h2>\n<table>\n", heading);
  for (size_t i = first; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    html += fmt::format(
        "<tr><td>{}</td><td>{:.1f}</td><td><div class=\"bar\" style=\"width:{:.0f}px\"></div></td>"
        "</tr>\n",
        names[i], 100 * values[i], 300 * values[i]);
  }
  return html + "</table>\n";
}

}  // namespace

std::string EvaluationJson(const Evaluation& e) {
  nlohmann::ordered_json json;
  json["frames"] = e.frames;
  json["people"] = e.people;
  json["pixel_accuracy"] = Number(e.pixel_accuracy);
  json["mean_class_accuracy"] = Number(e.mean_class_accuracy);
  json["mean_class_accuracy_first_stage"] = Number(e.mean_class_accuracy_first_stage);
  json["per_class_accuracy"] = ByName(e.class_accuracy, recon::kPartNames, 1);
  json["map_10cm"] = Number(e.map_10cm);
  json["ap_10cm"] = ByName(e.ap_10cm, recon::kJointNames, 0);
  json["map_10cm_visible"] = Number(e.map_10cm_visible);
  json["ap_10cm_visible"] = ByName(e.ap_10cm_visible, recon::kJointNames, 0);
  json["mean_common_accuracy"] = Number(e.mean_common_accuracy);
  json["per_common_part_accuracy"] = ByName(e.common_accuracy, CommonPartNames(), 0);
  json["map_10cm_common"] = Number(e.map_10cm_common);
  json["confidence_of_seen_joints"] = CalibrationJson(e.seen_joints);
  json["confidence_of_inferred_joints"] = CalibrationJson(e.inferred_joints);
  json["swapped_left_right"] = Number(e.swapped_left_right);
  json["swapped_left_right_turned"] = Number(e.swapped_left_right_turned);
  json["ns_per_pixel"] = e.ns_per_pixel;
  json["classify_ms"] = e.classify_ms;
  json["propose_ms"] = e.propose_ms;
  json["relabel_ns_per_pixel"] = e.relabel_ns_per_pixel;
  return json.dump(2) + "\n";
}

std::string EvaluationHtml(const Evaluation& e, const std::string& title) {
  std::string html = fmt::format(
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n"
      "<style>body{{font:15px sans-serif;max-width:46em;margin:2em auto}}td{{padding:1px 8px}}"
      ".bar{{background:#3a7ca5;height:11px}}.confusion "
      "td{{width:12px;height:12px;padding:0;border:1px solid #eee}}"
      ".confusion th{{font-weight:normal;text-align:right}}img{{max-width:100%}}figure{{margin:1em "
      "0}}"
      "svg text{{font:11px "
      "sans-serif}}.grid{{stroke:#e4e4e4}}.plot{{width:100%}}</style></head><body>\n"
      "<h1>{0}</h1>\n",
      Escaped(title));
  html += fmt::format(
      "<p>{} frames, {} people. Pixels right: {} %. Mean of the classes: {} %. Joint mAP at "
      "10 cm: {}, visible joints only: {}. Left and right swapped: {} % of all people, "
      "{} % of those turned by more than 60°. {:.0f} ns a person pixel; classify {:.2f} ms, "
      "propose {:.2f} ms a person.</p>\n",
      e.frames, e.people, Shown(e.pixel_accuracy, 100, 1), Shown(e.mean_class_accuracy, 100, 1),
      Shown(e.map_10cm, 1, 3), Shown(e.map_10cm_visible, 1, 3), Shown(e.swapped_left_right, 100, 1),
      Shown(e.swapped_left_right_turned, 100, 1), e.ns_per_pixel, e.classify_ms, e.propose_ms);
  html += Bars("Pixels right by part, %", e.class_accuracy, recon::kPartNames, 1);
  html += Bars("Average precision by joint, %", e.ap_10cm, recon::kJointNames, 0);
  html += ConfusionMatrix(e.confusion);
  html += WorstFrames(e.worst_frames);
  html += CalibrationPlot(e);
  html += CalibrationTable("Confidence of joints that are seen", e.seen_joints);
  html += CalibrationTable("Confidence of joints that are inferred", e.inferred_joints);
  return html + "</body></html>\n";
}

}  // namespace ossa::tools
