// `ossa experiment fit`: the effect of the surface fit and of each of its terms on the tracker's
// final joints on real stills.
#include <fmt/format.h>

#include <algorithm>

#include "depth/base/error.h"
#include "depth/base/statistics.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/fit/track_person_internal.h"
#include "tools/experiments/real/real_evaluation_internal.h"
#include "tools/experiments/sdk/method_runs.h"

namespace ossa::tools {
namespace {

using recon::SurfaceFitOptions;

struct Variant {
  std::string name;
  std::optional<SurfaceFitOptions> options;  // empty: no fit
};

template <typename Change>
Variant With(const std::string& name, const Change& change) {
  SurfaceFitOptions options;
  change(options);
  return {name, options};
}

// By hand, factors: terms that are switched off keep a tiny weight so that the system stays
// solvable.
constexpr double kHardly = 0.01;

std::vector<Variant> Variants() {
  return {
      {"off", std::nullopt},
      {"on", SurfaceFitOptions{}},
      With("joints alone", [](auto& o) { o.pixels = o.silhouette = o.retry = false; }),
      With("without pixels", [](auto& o) { o.pixels = false; }),
      With("without parts", [](auto& o) { o.adjacent_part_m = o.other_part_m = 0.0; }),
      With("without distance along", [](auto& o) { o.along_share = 0.0; }),
      With("without silhouette", [](auto& o) { o.silhouette = false; }),
      With("with free space", [](auto& o) { o.free_space = true; }),
      With("the fitted joints alone", [](auto& o) { o.fitted_m = 0.0; }),
      With("joints hardly count", [](auto& o) { o.joint_m /= kHardly; }),
      With("without how people turn", [](auto& o) { o.turn_weight *= kHardly; }),
      With("any shape", [](auto& o) { o.shape_weight *= kHardly; }),
      With("shapes near the mean", [](auto& o) { o.shape_weight *= 5.0; }),
      With("mean shape only", [](auto& o) { o.shape_weight /= kHardly * kHardly; }),
      With("without a second fit", [](auto& o) { o.retry = false; }),
      With("residuals as reliability, 3 cm", [](auto& o) { o.doubt_residual_m = 0.03; }),
      With("residuals as reliability, 6 cm", [](auto& o) { o.doubt_residual_m = 0.06; }),
      With("2 iterations", [](auto& o) { o.iterations = 2; }),
      With("15 iterations", [](auto& o) { o.iterations = 15; }),
  };
}

/// Results of the fits of a set's stills.
struct FitFigures {
  std::vector<double> explained, residual_m, ms;
  void Add(const StillResult& result) {
    if (!result.fit) return;
    explained.push_back(result.fit->explained);
    residual_m.push_back(result.fit->median_residual_m);
    ms.push_back(result.fit_ms);
  }
};

std::string FormatMedian(std::vector<double> values, double scale, const char* form) {
  if (values.empty()) return "-";
  return fmt::format(fmt::runtime(form), scale * ossa::Median(std::move(values)));
}

Table FitTable() {
  return {
      .title = "The surface fit on real stills: final joints, offset removed",
      .columns = {"fit", "set", "stills", "mean, cm", "within 5 cm, %", "within 10 cm, %",
                  "explained, %", "residual, mm", "ms"},
      .rows = {},
      .note =
          "Final: what an application gets; sets and offsets as of `ossa experiment real`. "
          "Explained: share of the person's pixels within 3 cm of the fitted surface, median "
          "over the stills. Residual: distance of a person's pixels from it, median of medians. "
          "ms: of the fit alone, median, on this machine."};
}

void AddRow(const Variant& variant, const RealSet& set, const std::vector<StillResult>& results,
            Table& table) {
  FitFigures figures;
  for (const StillResult& result : results) figures.Add(result);
  const std::vector<bool> all(set.joints.size(), true);
  const StageScore score = ScoreStage(set, results, RealStage::kFinal, true, all);
  const std::string name = set.name + (score.offset_removed ? "" : " (too few: none removed)");
  table.rows.push_back({variant.name, name, std::to_string(results.size()), Cell(score.mean_cm),
                        fmt::format("{:.1f}", 100 * score.within_5cm),
                        fmt::format("{:.1f}", 100 * score.within_10cm),
                        FormatMedian(figures.explained, 100, "{:.1f}"),
                        FormatMedian(figures.residual_m, 1000, "{:.1f}"),
                        FormatMedian(figures.ms, 1, "{:.2f}")});
}

constexpr int kMostPerHeight = 20;  // by hand: takes a night

std::set<std::string> ReadParts(Parameters& parameters) {
  return parameters.Some("parts", {"terms", "people", "starts", "shapes"});
}

int ReadFrameCount(Parameters& parameters) { return parameters.Integer("frames", 0); }

std::vector<Table> FitTerms(ExperimentContext& context) {
  if (context.shared.empty()) throw InputError("fit: expected --shared FOLDER with real/ in it");
  const auto sets = ReadRealSets(context.shared, ReadFrameCount(context.parameters));
  if (sets.empty()) {
    throw InputError(fmt::format("{}: expected real/depth_frames or real/itop_depth in it",
                                 context.shared.string()));
  }
  tracker::TrackerOptions options = TrackerOptionsOf(context);
  Table table = FitTable();
  const auto variants = Variants();
  for (const Variant& variant : variants) {
    options.fit = variant.options;
    tracker::Tracker tracker(options);
    for (const RealSet& set : sets) {
      std::vector<StillResult> results;
      for (const RealStill& still : set.stills) {
        context.ThrowIfInterrupted();
        results.push_back(EvaluateStill(set, still, tracker));
      }
      AddRow(variant, set, results, table);
    }
    if (context.progress) {
      context.progress(static_cast<double>(&variant - variants.data() + 1),
                       static_cast<double>(variants.size()), variant.name);
    }
  }
  return {table};
}

}  // namespace

FitSettings ReadFitSettings(Parameters& parameters) {
  return {parameters.Integer("people_per_height", 3, 1, kMostPerHeight),
          parameters.Integer("start_people_per_height", 2, 1, kMostPerHeight),
          parameters.Integer("shape_people_per_height", 1, 1, kMostPerHeight),
          parameters.Flag("train_shapes", false)};
}

void ReadFitParameters(ExperimentContext& context) {
  ReadParts(context.parameters);
  ReadFrameCount(context.parameters);
  ReadFitSettings(context.parameters);
}

std::vector<Table> RunFit(ExperimentContext& context) {
  const auto parts = ReadParts(context.parameters);
  std::vector<Table> tables;
  const auto add = [&](const char* part, std::vector<Table> (*run)(ExperimentContext&)) {
    if (parts.count(part) == 0) return;
    for (Table& table : run(context)) tables.push_back(std::move(table));
  };
  add("terms", FitTerms);
  add("people", FitPeople);
  add("starts", FitStarts);
  add("shapes", FitWrongShapes);
  return tables;
}

}  // namespace ossa::tools
