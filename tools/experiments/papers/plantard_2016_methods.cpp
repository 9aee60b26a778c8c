// Plantard et al. 2016, figure 5 and section 8.2: the methods over the scenarios, and the tests
// between them.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/experiments/compare/significance.h"
#include "tools/experiments/papers/plantard_2016_internal.h"

namespace ossa::tools {
namespace {

constexpr auto kError = &ClipMetrics::parent_relative_error_cm;
constexpr auto kOver = &ClipMetrics::fraction_frames_over_20cm;

struct Spread {
  double mean = 0, deviation = 0, low = 0, high = 0;
};

std::optional<Spread> ComputeSpread(const std::vector<double>& values, double scale = 1) {
  if (values.empty()) return std::nullopt;
  Spread spread;
  const auto n = static_cast<double>(values.size());
  for (const double value : values) spread.mean += scale * value / n;
  for (const double value : values) {
    const double off = scale * value - spread.mean;
    spread.deviation += off * off / std::max(1.0, n - 1);
  }
  spread.deviation = std::sqrt(spread.deviation);
  spread.low = scale * *std::min_element(values.begin(), values.end());
  spread.high = scale * *std::max_element(values.begin(), values.end());
  return spread;
}

std::string ErrorCell(const std::optional<Spread>& error) {
  return error ? fmt::format("{:.2f} ({:.2f})", error->mean, error->deviation) : "-";
}

std::string ShareCell(const std::optional<Spread>& share) {
  if (!share) return "-";
  return fmt::format("{:.1f} ({:.1f}, {:.1f}-{:.1f})", share->mean, share->deviation, share->low,
                     share->high);
}

}  // namespace

Table MakePlantard2016FigureFive(const std::vector<std::string>& labels,
                                 const std::vector<std::vector<ClipMetrics>>& clips,
                                 const std::vector<std::vector<ClipMetrics>>& seen) {
  Table table;
  table.title = "Figure 5: mean error and frames of 20 cm or more, over the scenarios";
  table.columns = {"method",   "eq. 13, cm (sigma)",      "paper, cm", ">20 cm, % (sigma, min-max)",
                   "paper, %", "somebody seen: >20 cm, %"};
  const std::array<std::pair<const char*, const char*>, 5> paper = {
      {{"15 (4)", "19.1 (27.3, 0.3-92.1)"},
       {"10 (2)", "8.8 (7.9, 0-19.7)"},
       {"9 (2)", "3.3 (3.9, 0-10.5)"},
       {"-", "-"},
       {"-", "-"}}};
  const auto error = SharedValues(clips, kError);
  const auto over = SharedValues(clips, kOver);
  const auto over_where_seen = SharedValues(seen, kOver);
  for (size_t m = 0; m < labels.size(); ++m) {
    const auto where_seen = ComputeSpread(over_where_seen[m], 100);
    table.rows.push_back({labels[m], ErrorCell(ComputeSpread(error[m])), paper.at(m).first,
                          ShareCell(ComputeSpread(over[m], 100)), paper.at(m).second,
                          where_seen ? Cell(where_seen->mean, 1) : "-"});
  }
  table.note =
      "Paper: Kinect, its [37] (shum-2013) and its own method on industrial recordings. Its "
      "physical filter (section 7) is in the row + physics alone.";
  if (const size_t left_out = clips[0].size() - error[0].size(); left_out > 0) {
    table.note +=
        fmt::format(" Without {} of {} scenarios, in which some method has nothing to compare.",
                    left_out, clips[0].size());
  }
  return table;
}

Table MakePlantard2016FigureEight(const std::vector<std::string>& labels,
                                  const std::vector<std::vector<PairedTracks>>& pairs) {
  constexpr size_t kPoses = 4;  // figure 8
  struct Pose {
    double raw_cm;
    size_t scenario, frame;
  };
  std::vector<Pose> worst;  // of each scenario
  for (size_t s = 0; s < pairs.at(0).size(); ++s) {
    const auto errors = ErrorsByFrame(pairs[0][s]).parent_relative_cm;
    Pose pose{-1.0, s, 0};
    for (size_t f = 0; f < errors.size(); ++f) {
      if (errors[f] && *errors[f] > pose.raw_cm) pose = {*errors[f], s, f};
    }
    if (pose.raw_cm >= 0.0) worst.push_back(pose);
  }
  std::sort(worst.begin(), worst.end(),
            [](const Pose& a, const Pose& b) { return a.raw_cm > b.raw_cm; });
  worst.resize(std::min(worst.size(), kPoses));
  Table table;
  table.title = "Figure 8: challenging poses, eq. 13, cm";
  table.columns = {"scenario", "second"};
  table.columns.insert(table.columns.end(), labels.begin(), labels.end());
  for (const Pose& pose : worst) {
    const double second = pairs[0][pose.scenario].time_s[pose.frame];
    table.rows.push_back({std::to_string(pose.scenario + 1), fmt::format("{:.2f}", second)});
    for (const auto& of_method : pairs) {
      const auto errors = ErrorsByFrame(of_method[pose.scenario]).parent_relative_cm;
      table.rows.back().push_back(pose.frame < errors.size() ? Cell(errors[pose.frame]) : "-");
    }
  }
  table.note = "The frames in which raw is worst, each of another scenario.";
  return table;
}

Table MakePlantard2016Tests(const std::vector<std::string>& labels,
                            const std::vector<std::vector<ClipMetrics>>& clips) {
  Table table;
  table.title = "Section 8.2: paired tests over the scenarios";
  table.columns = {"quantity", "test", "between", "statistic", "p (Bonferroni)"};
  const auto add = [&](const char* quantity, const char* test, const std::string& between,
                       const std::optional<TestResult>& result, double corrections) {
    if (!result) return;
    table.rows.push_back({quantity, test, between, fmt::format("{:.4g}", result->statistic),
                          fmt::format("{:.3g}", std::min(1.0, corrections * result->p))});
  };
  const std::vector<std::vector<ClipMetrics>> of_paper(clips.begin(), clips.begin() + 3);
  const auto error = SharedValues(of_paper, kError);
  const auto over = SharedValues(of_paper, kOver);
  for (size_t m = 0; m < 3; ++m) {
    add("eq. 13", "Lilliefors normality", labels[m], Lilliefors(error[m]), 1);
  }
  add("eq. 13", "repeated-measures Anova", "raw, shum-2013, plantard-2016", RepeatedAnova(error),
      1);
  add("share over 20 cm", "Friedman", "raw, shum-2013, plantard-2016", Friedman(over), 1);
  for (size_t a = 0; a < 3; ++a) {
    for (size_t b = a + 1; b < 3; ++b) {
      const std::string between = labels[a] + " / " + labels[b];
      add("eq. 13", "paired t", between, PairedT(error[a], error[b]), 3);
      add("share over 20 cm", "Wilcoxon signed rank", between, Wilcoxon(over[a], over[b]), 3);
    }
  }
  table.note =
      "Paper: both methods below the Kinect at p < 0.001 (Anova, Bonferroni); its own below the "
      "Kinect and below [37] in frames over 20 cm at p < 0.01 (Friedman, Wilcoxon).";
  return table;
}

}  // namespace ossa::tools
