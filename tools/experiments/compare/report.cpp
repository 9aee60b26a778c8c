// The HTML report of a comparison: one file, no scripts, no other files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/compare/svg_plot.h"

namespace ossa::tools {
namespace {

// Constants: sizes of the page's plots, pixels, by eye.

constexpr const char* kHead = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>ossa compare</title><style>
body{font:15px/1.45 system-ui,sans-serif;color:#222;max-width:920px;margin:2em auto;padding:0 1em}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:2em}
table{border-collapse:collapse;font-size:13px}td,th{border-bottom:1px solid #ddd;padding:3px 9px;
text-align:right}td:first-child,th:first-child{text-align:left}
svg text{font:11px system-ui,sans-serif;fill:#444}.grid{stroke:#e4e4e4}.plot{width:100%}
.legend,.note{font-size:13px;color:#444}.scroll{overflow-x:auto}
.frames{display:flex;flex-wrap:wrap;gap:10px}.frames figure{margin:0;border:1px solid #ddd}
figcaption{font-size:12px;padding:2px 6px}</style></head><body>
)";

std::string Number(const std::optional<double>& value, int digits = 2, double scale = 1) {
  return value ? fmt::format("{:.{}f}", scale * *value, digits) : "–";
}

std::string Cells(const std::vector<std::string>& cells, const char* tag) {
  std::string row = "<tr>";
  for (const std::string& cell : cells) row += fmt::format("<{0}>{1}</{0}>", tag, Escaped(cell));
  return row + "</tr>\n";
}

std::string Range(const std::optional<Interval>& interval) {
  return interval ? fmt::format(" [{:.2f}, {:.2f}]", interval->low, interval->high) : "";
}

std::string Summary(const Comparison& comparison) {
  std::string html = "<div class=\"scroll\"><table>" +
                     Cells({"result", "clips", "frames", "mean error, cm", "eq. 18, cm",
                            "frames over 20 cm, %", "joints missing, %", "joints within 10 cm, %",
                            "mAP 10 cm, %", "acceleration, cm/frame²", "offset removed, cm",
                            "bone lengths vary, %", "p95 / p99, cm", "time offset, s"},
                           "th");
  for (const ComparedResult& r : comparison.results) {
    const ClipMetrics& m = r.mean;
    html += Cells(
        {r.label, std::to_string(r.clips.size()), std::to_string(m.frames),
         Number(m.mean_joint_error_cm) + Range(r.mean_joint_error_interval),
         Number(m.parent_relative_error_cm) + Range(r.parent_relative_error_interval),
         Number(m.fraction_frames_over_20cm, 1, 100), Number(m.fraction_joints_missing, 1, 100),
         Number(m.fraction_joints_within_10cm, 1, 100), Number(m.map_10cm, 1, 100),
         Number(m.acceleration_error_cm_per_frame2), Number(m.offset_removed_error_cm),
         Number(m.bone_length_variation_percent), Number(m.p95_cm, 1) + " / " + Number(m.p99_cm, 1),
         m.same_clock ? "0 (times agree)" : fmt::format("{:+.3f}", m.offset_s)},
        "td");
  }
  return html +
         "</table></div><p class=\"note\">Numbers over several clips are means of the "
         "clips', in brackets their 95 % bootstrap interval. eq. 18: joints relative to "
         "their parents (Shum 2013). Frames over 20 cm: by that error (Plantard 2016). "
         "Joints that are missing, also those of frames that a result leaves out, are in no "
         "error and count as not within 10 cm.</p>";
}

std::string Tests(const Comparison& comparison) {
  if (comparison.tests.empty()) return {};
  std::string html =
      "<h2>Paired tests over clips</h2><div class=\"scroll\"><table>" +
      Cells({"quantity", "test", "between", "clips", "statistic", "p", "p after Bonferroni"}, "th");
  for (const ComparedTest& test : comparison.tests) {
    html += Cells({test.quantity, test.test, test.between, std::to_string(test.units),
                   fmt::format("{:.4g}", test.result.statistic),
                   fmt::format("{:.3g}", test.result.p), fmt::format("{:.3g}", test.corrected_p)},
                  "td");
  }
  return html +
         "</table></div><p class=\"note\">Normally distributed: Anova and paired t; else "
         "Friedman and Wilcoxon.</p>";
}

const PairedTracks* PairNamed(const ComparedResult& result, const std::string& name) {
  for (const PairedTracks& pair : result.pairs) {
    if (pair.name == name) return &pair;
  }
  return nullptr;
}

// The clip that is shown: the one in which the first result is worst.
std::string ShownClip(const Comparison& comparison) {
  const auto& clips = comparison.results[0].clips;
  const auto worst =
      std::max_element(clips.begin(), clips.end(), [](const ClipMetrics& a, const ClipMetrics& b) {
        return a.mean_joint_error_cm.value_or(0) < b.mean_joint_error_cm.value_or(0);
      });
  return worst->name;
}

// Limits the points of a line: takes the largest of each group, so that peaks stay.
Series Thinned(const Series& series) {
  constexpr size_t kMostPoints = 1500;
  const size_t group = series.x.size() / kMostPoints + 1;
  if (group == 1) return series;
  Series thin{series.name, {}, {}};
  for (size_t i = 0; i < series.x.size(); i += group) {
    size_t peak = i;
    for (size_t k = i; k < std::min(i + group, series.x.size()); ++k) {
      if (series.y[k].value_or(-1) > series.y[peak].value_or(-1)) peak = k;
    }
    thin.x.push_back(series.x[peak]);
    thin.y.push_back(series.y[peak]);
  }
  return thin;
}

std::string ErrorOverTime(const Comparison& comparison) {
  const std::string clip = ShownClip(comparison);
  std::vector<Series> series;
  for (const ComparedResult& result : comparison.results) {
    const PairedTracks* pair = PairNamed(result, clip);
    if (pair == nullptr) continue;
    series.push_back(Thinned({result.label, pair->time_s, ErrorsByFrame(*pair).mean_joint_cm}));
  }
  const std::string which = comparison.results[0].clips.size() > 1
                                ? " (the first result's worst clip: " + clip + ")"
                                : "";
  return "<h2>Error over time" + Escaped(which) + "</h2>" +
         LinePlot(series, {"time, s", "mean joint error, cm", {}, {}});
}

std::string CumulativeCurves(const Comparison& comparison) {
  constexpr double kFarthest_cm = 30;
  std::vector<Series> series;
  for (const ComparedResult& result : comparison.results) {
    std::vector<double> errors;
    for (const PairedTracks& pair : result.pairs) {
      const auto some = JointErrors_cm(pair);
      errors.insert(errors.end(), some.begin(), some.end());
    }
    std::sort(errors.begin(), errors.end());
    Series line{result.label, {}, {}};
    for (int step = 0; step <= 120; ++step) {
      const double error_cm = kFarthest_cm * step / 120;
      const auto below = std::upper_bound(errors.begin(), errors.end(), error_cm) - errors.begin();
      line.x.push_back(error_cm);
      line.y.push_back(errors.empty() ? 0.0
                                      : 100.0 * static_cast<double>(below) /
                                            static_cast<double>(errors.size()));
    }
    series.push_back(std::move(line));
  }
  return "<h2>Joints within a distance of the truth</h2>" +
         LinePlot(series, {"distance, cm", "joints, %", kFarthest_cm, 100.0});
}

std::string JointBars(const Comparison& comparison) {
  std::vector<std::string> joints;
  std::vector<std::vector<std::optional<double>>> values(comparison.results.size());
  std::vector<std::string> names;
  for (const ComparedResult& result : comparison.results) names.push_back(result.label);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool any =
        std::any_of(comparison.results.begin(), comparison.results.end(),
                    [&](const ComparedResult& r) { return r.mean.per_joint_cm[j].has_value(); });
    if (!any) continue;
    joints.emplace_back(recon::kJointNames[j]);
    for (size_t r = 0; r < comparison.results.size(); ++r) {
      values[r].push_back(comparison.results[r].mean.per_joint_cm[j]);
    }
  }
  return "<h2>Mean error by joint</h2>" + BarPlot(names, joints, values, "cm");
}

// A posture from the front (as the camera sees it: x to the left) and from its left side, in one
// box; `centre` is the truth's, so that shifts show.
std::string Bones(const SparsePosture& posture, const Eigen::Vector3d& centre, bool side,
                  const std::string& colour) {
  constexpr double kPixelsPerMetre = 85;  // pixels
  constexpr double kCentreX = 85;         // pixels
  constexpr double kCentreY = 100;        // pixels
  const auto point = [&](size_t j) {
    const Eigen::Vector3d p = kPixelsPerMetre * (posture.position_m[j] - centre);
    return std::pair{kCentreX + (side ? p.z() + 170 : -p.x()), kCentreY - p.y()};
  };
  std::string svg;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!posture.present[j]) continue;
    const auto [x, y] = point(j);
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.2\" fill=\"{}\"/>", x, y, colour);
    size_t parent = recon::ParentOf(j);
    while (parent != 0 && !posture.present[parent]) parent = recon::ParentOf(parent);
    if (j == 0 || !posture.present[parent]) continue;
    const auto [px, py] = point(parent);
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" "
        "stroke-width=\"2\"/>",
        px, py, x, y, colour);
  }
  return svg;
}

Eigen::Vector3d ComputeCentre(const SparsePosture& posture) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!posture.present[j]) continue;
    sum += posture.position_m[j];
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : sum;
}

std::string DrawnFrame(const PairedTracks& pair, size_t frame, size_t colour, double error_cm) {
  const Eigen::Vector3d centre = ComputeCentre(pair.truth[frame]);
  std::string svg = "<svg width=\"340\" height=\"210\" viewBox=\"0 0 340 210\">";
  for (const bool side : {false, true}) {
    svg += Bones(pair.truth[frame], centre, side, kTruthColour);
    svg += Bones(pair.result[frame], centre, side, SeriesColour(colour));
  }
  return fmt::format("<figure>{}</svg><figcaption>{} t = {:.2f} s: {:.1f} cm</figcaption></figure>",
                     svg, Escaped(pair.name), pair.time_s[frame], error_cm);
}

struct WorstFrame {
  const PairedTracks* pair;
  size_t frame;
  double error_cm;
};

// The worst frames, at least half a second apart, because neighbours show the same failure.
std::vector<WorstFrame> FindWorst(const ComparedResult& result) {
  constexpr size_t kShown = 4;
  constexpr double kApart_s = 0.5;
  std::vector<WorstFrame> all;
  for (const PairedTracks& pair : result.pairs) {
    const auto errors = ErrorsByFrame(pair).mean_joint_cm;
    for (size_t f = 0; f < errors.size(); ++f) {
      if (errors[f]) all.push_back({&pair, f, *errors[f]});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const WorstFrame& a, const WorstFrame& b) {
    return a.error_cm > b.error_cm;
  });
  std::vector<WorstFrame> worst;
  for (const WorstFrame& frame : all) {
    if (worst.size() == kShown) break;
    const bool near = std::any_of(worst.begin(), worst.end(), [&](const WorstFrame& other) {
      return other.pair == frame.pair &&
             std::abs(other.pair->time_s[other.frame] - frame.pair->time_s[frame.frame]) < kApart_s;
    });
    if (!near) worst.push_back(frame);
  }
  return worst;
}

std::string WorstFrames(const Comparison& comparison) {
  std::string html =
      "<h2>Worst frames</h2><p class=\"note\">Front (as the camera sees it) and side; grey is the "
      "truth.</p>";
  for (size_t r = 0; r < comparison.results.size(); ++r) {
    html += fmt::format("<h3>{}</h3><div class=\"frames\">", Escaped(comparison.results[r].label));
    for (const WorstFrame& worst : FindWorst(comparison.results[r])) {
      html += DrawnFrame(*worst.pair, worst.frame, r, worst.error_cm);
    }
    html += "</div>";
  }
  return html;
}

std::string ClipTable(const Comparison& comparison) {
  if (comparison.results[0].clips.size() < 2) return {};
  std::string html =
      "<h2>By clip</h2><details><summary>all clips</summary><div class=\"scroll\"><table>" +
      Cells({"clip", "result", "frames", "mean error, cm", "eq. 18, cm", "offset removed, cm",
             "time offset, s"},
            "th");
  for (const ComparedResult& result : comparison.results) {
    for (const ClipMetrics& clip : result.clips) {
      html += Cells({clip.name, result.label, std::to_string(clip.frames),
                     Number(clip.mean_joint_error_cm), Number(clip.parent_relative_error_cm),
                     Number(clip.offset_removed_error_cm), fmt::format("{:.3f}", clip.offset_s)},
                    "td");
    }
  }
  return html + "</table></div></details>";
}

}  // namespace

std::string ToHtml(const Comparison& comparison) {
  std::string html = kHead;
  html += fmt::format(
      "<h1>Skeletons against {}</h1><p class=\"note\">Alignment: {}{}. {}</p>\n",
      Escaped(comparison.truth), comparison.rigid ? "one rigid transform a clip" : "none",
      comparison.found_only ? "; joints found only" : "", Escaped(MakeAdvice(comparison)));
  html += Summary(comparison) + "\n" + ErrorOverTime(comparison) + "\n" +
          CumulativeCurves(comparison) + "\n" + JointBars(comparison) + "\n" +
          WorstFrames(comparison) + "\n" + Tests(comparison) + ClipTable(comparison);
  return html + "</body></html>\n";
}

}  // namespace ossa::tools
