// Shum 2013, figures 8 and 9, and the terms of eq. 15: cost and gain of the parameters and steps of
// the method.
#include <fmt/format.h>

#include <array>

#include "depth/base/atomic_file.h"
#include "depth/base/stopwatch.h"
#include "physics/character_filter.h"
#include "recon/body/standard_body.h"
#include "recon/database/posture_database.h"
#include "recon/motion/mocap.h"
#include "recon/reliability.h"
#include "tools/experiments/compare/svg_plot.h"
#include "tools/experiments/papers/shum_2013_internal.h"
#include "tools/experiments/papers/visibility_errors.h"

namespace ossa::tools {
namespace {

struct Sweep {
  std::string name;                           // of the parameter
  std::string paper;                          // its value in table V
  std::vector<double> values;                 // of the sweep
  void (*set)(MethodRun& run, double value);  // run.options.database is the study's
};

/// A database from ossa's authored clips (those of the shipped database) with the paper's filter
/// (sec. V-A): the root of the sum of squared joint distances is at least `threshold_m`.
std::shared_ptr<const recon::PostureDatabase> FilteredBySum(double threshold_m) {
  static const std::vector<recon::PostureClip> clips = [] {
    std::vector<recon::PostureClip> made;
    for (const recon::MotionClip& clip : recon::LoadMocap({"authored"}, {})) {
      recon::PostureClip& postures = made.emplace_back();
      postures.name = clip.name;
      for (const recon::RigPose& pose : clip.frames) {
        postures.postures.push_back(recon::StandardPosture(pose));
        postures.orientations.push_back(recon::ComputeOrientations(pose));
      }
    }
    return made;
  }();
  recon::DatabaseOptions options;
  options.filter = recon::DatabaseFilter::kSumSquared;
  options.threshold_m = threshold_m;
  return std::make_shared<recon::PostureDatabase>(recon::PostureDatabase::Build(clips, options));
}

std::vector<Sweep> Sweeps(bool full) {
  const auto some = [full](std::vector<double> few, std::vector<double> many) {
    return full ? many : few;
  };
  return {
      {"root of the filter's threshold, m", "2574 postures",
       some({1.6, 0.8, 0.4}, {2.4, 1.6, 1.2, 0.8, 0.6, 0.4, 0.3}),
       [](MethodRun& run, double value) {
         run.options.database = FilteredBySum(value);
         run.database_key = fmt::format("authored, sum of squares {}", value);
       }},
      {"neighbours K", "30", some({10, 30, 90}, {5, 10, 20, 30, 50, 90, 150}),
       [](MethodRun& run, double value) {
         run.options.local_pca.neighbours = static_cast<int>(value);
       }},
      {"dimensions", "20", some({5, 20, 29}, {3, 5, 10, 15, 20, 25, 29}),
       [](MethodRun& run, double value) {
         run.options.local_pca.dimensions = static_cast<int>(value);
       }},
      {"optimisation steps", "20", some({5, 20, 40}, {1, 5, 10, 15, 20, 30, 40}),
       [](MethodRun& run, double value) { run.options.local_pca.steps = static_cast<int>(value); }},
      {"samples a step", "100", some({25, 100, 200}, {10, 25, 50, 100, 150, 200}),
       [](MethodRun& run, double value) {
         run.options.local_pca.samples = static_cast<int>(value);
       }}};
}

Table FigureEight(ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title = "Figure 8: error and time by parameter (shum-2013, furniture)";
  table.columns = {"parameter", "paper's choice", "value", "postures", "eq. 18, cm", "ms a frame"};
  std::string plots;
  for (const Sweep& sweep : Sweeps(context.full)) {
    Series line{"eq. 18, cm", {}, {}};
    for (const double value : sweep.values) {
      MethodRun run = study.shum;
      run.database_key = ComputeFileKey(LoadDatabase(context).path);
      sweep.set(run, value);
      run.label = fmt::format("{} = {}", sweep.name, value);
      const auto mean =
          MeanOverClips(run.label, MeasureAll(RunOverClips(context, run, study.furniture)));
      const double ms = MedianStep_ms(run, study.furniture.at(0).observed);
      table.rows.push_back({sweep.name, sweep.paper, fmt::format("{}", value),
                            std::to_string(run.options.database->size()),
                            Cell(mean.parent_relative_error_cm), Cell(ms)});
      line.x.push_back(value);
      line.y.push_back(mean.parent_relative_error_cm);
    }
    plots += "<h2>" + Escaped(sweep.name) + "</h2>" +
             LinePlot({line}, {sweep.name, "eq. 18, cm", {}, {}});
  }
  AtomicFile file(context.out / "figure8.html");
  file.stream() << "<!doctype html><meta charset=\"utf-8\"><title>Figure 8</title>" << plots;
  file.Commit();
  table.note =
      "The paper plots its optimisation score, which says how well a posture explains a wrong "
      "observation; here the error against the truth, and the median time of this machine. The "
      "filter is the paper's, which puts its threshold on the sum of squares. "
      "Drawn in figure8.html.";
  return table;
}

template <typename Step>
double MeasureMilliseconds(const Step& step, size_t times) {
  const Stopwatch watch;
  for (size_t i = 0; i < times; ++i) step(i);
  return watch.milliseconds() / static_cast<double>(std::max<size_t>(1, times));
}

// Time of search and space: that of a frame with hardly any optimisation. Reliability and character
// are timed separately.
Table FigureNine(const Shum2013Study& study) {
  const recon::SkeletonSequence& clip = study.furniture.at(0).observed;
  MethodRun idle = study.shum;
  idle.options.local_pca.steps = 1;
  idle.options.local_pca.samples = 1;
  const double whole_ms = MedianStep_ms(study.shum, clip);
  const double idle_ms = MedianStep_ms(idle, clip);
  recon::ReliabilityEstimator reliability;
  const double reliability_ms = MeasureMilliseconds(
      [&](size_t i) {
        reliability.Step(recon::ToTrackedPosture(clip.frames[i].bodies.at(0)), nullptr);
      },
      clip.frames.size());
  physics::CharacterFilter character(recon::StandardBoneLengths());
  const double physics_ms = MeasureMilliseconds(
      [&](size_t i) {
        const auto& body = study.furniture[0].truth.frames[i].bodies.at(0);
        character.Step(recon::ToTrackedPosture(body).posture, {}, std::nullopt, 1.0 / 30);
      },
      std::min<size_t>(60, clip.frames.size()));
  const double total_ms = whole_ms + physics_ms;
  Table table;
  table.title = "Figure 9: shares of the time of a frame";
  table.columns = {"step", "ms", "share, %", "paper, %"};
  const auto add = [&](const char* step, double ms, const char* paper) {
    table.rows.push_back({step, Cell(ms, 3), Cell(100 * ms / total_ms, 1), paper});
  };
  add("reliability", reliability_ms, "-");
  add("search and posture space", std::max(0.0, idle_ms - reliability_ms), "-");
  add("optimisation", std::max(0.0, whole_ms - idle_ms), "66");
  add("physical character", physics_ms, "-");
  add("all", total_ms, "100 (27.7 ms)");
  table.note =
      "The paper: Intel Core i7-2630, 2 GHz; its chart names only the optimisation's share in the "
      "text. Times are of this machine, over one clip: medians of frames; means of reliability and "
      "character.";
  return table;
}

/// The gain of each term of eq. 15, of the reliability and of the search. The paper only has method
/// B.
Table WithoutEachTerm(const ExperimentContext& context, const Shum2013Study& study) {
  struct Variant {
    const char* name;
    void (*set)(recon::LocalPcaOptions& options);
  };
  constexpr std::array<Variant, 7> kVariants = {
      {{"as in the paper", [](recon::LocalPcaOptions&) {}},
       {"no reliability (method B)", [](auto& o) { o.use_reliability = false; }},
       {"no style term", [](auto& o) { o.style = 0.0; }},
       {"no kinematics term", [](auto& o) { o.kinematics = 0.0; }},
       {"no continuity term", [](auto& o) { o.continuity = 0.0; }},
       {"least squares (Ceres) for the stochastic search", [](auto& o) { o.solver = "ceres"; }},
       {"reliable joints kept", [](auto& o) { o.keep_reliable = true; }}}};
  Table table;
  table.title = "Without each term: eq. 18, and of bones seen at both ends / of the others";
  table.columns = {"shum-2013", "furniture, cm", "furniture by visibility, cm", "held thing, cm",
                   "held thing by visibility, cm"};
  for (const Variant& variant : kVariants) {
    MethodRun run = study.shum;
    run.label = variant.name;
    variant.set(run.options.local_pca);
    std::vector<std::string> row = {variant.name};
    for (const auto* clips : {&study.furniture, &study.held}) {
      const auto made = RunOverClips(context, run, *clips);
      const auto errors = ErrorsByVisibility(*clips, made);
      row.push_back(Cell(MeanOverClips(run.label, MeasureAll(made)).parent_relative_error_cm));
      row.push_back(Cell(errors.visible_cm) + " / " + Cell(errors.hidden_cm));
    }
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace

std::vector<Table> MakeShum2013Sweeps(ExperimentContext& context, const Shum2013Study& study) {
  return {WithoutEachTerm(context, study), FigureEight(context, study), FigureNine(study)};
}

}  // namespace ossa::tools
