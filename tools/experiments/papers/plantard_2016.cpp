// Plantard, Shum, Multon: Filtered pose graph for efficient Kinect pose reconstruction
// (2016): the ten scenarios of table 1, figures 5 to 8 and the tests of section 8.2; figures 5, 8
// and the tests are in plantard_2016_methods.cpp, figure 9 in plantard_2016_sweeps.cpp.
#include "tools/experiments/papers/plantard_2016_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>
#include <set>

#include "depth/base/atomic_file.h"
#include "tools/experiments/compare/svg_plot.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/simulation/motions.h"
#include "tools/experiments/simulation/recording_simulator.h"

namespace ossa::tools {
namespace {

constexpr size_t kScenarios = 10;  // table 1

struct Scenario {
  Clutter clutter;
  double azimuth_rad;
  const char* text;
};

// Table 1. Scenarios 8 and 10 are those with car seats of fig. 6.
Scenario MakeScenario(size_t index) {
  constexpr double kRight_rad = -std::numbers::pi / 4;  // table 1: 45 degrees
  if (index < 3) return {Clutter::kNone, 0.0, "few, front"};
  if (index < 7) {
    return {index % 2 == 1 ? Clutter::kFurniture : Clutter::kCarSeat, 0.0, "many, front"};
  }
  return {index == 8 ? Clutter::kFurniture : Clutter::kCarSeat, kRight_rad, "many, 45° right"};
}

struct Study {
  std::vector<RecordedPair> scenarios;
  std::vector<MethodRun> methods;  // raw, shum-2013, plantard-2016, best, plantard-2016 + physics
  std::vector<std::vector<PairedTracks>> pairs;  // [method][scenario]
  std::vector<std::vector<ClipMetrics>> clips;   // [method][scenario], errors of `pairs`
  std::vector<std::vector<ClipMetrics>> seen;    // the same over frames with observed joints only
  std::string note;

  void Add(ExperimentContext& context, MethodRun run);
};

bool IsWithoutJoints(const recon::SkeletonFrame& frame) {
  return std::all_of(frame.bodies.begin(), frame.bodies.end(), [](const recon::BodyRecord& body) {
    return std::none_of(body.joints.begin(), body.joints.end(),
                        [](const auto& joint) { return joint.has_value(); });
  });
}

// The frames with observed joints: a method cannot reconstruct frames without any.
PairedTracks FramesWithPeople(const RecordedPair& scenario, const PairedTracks& pair) {
  std::set<double> unseen_s;
  for (const auto& frame : scenario.observed.frames) {
    if (IsWithoutJoints(frame)) unseen_s.insert(frame.time_s);
  }
  PairedTracks seen{pair.name, {}, {}, {}};
  for (size_t f = 0; f < pair.time_s.size(); ++f) {
    if (unseen_s.contains(pair.time_s[f])) continue;
    seen.time_s.push_back(pair.time_s[f]);
    seen.truth.push_back(pair.truth[f]);
    seen.result.push_back(pair.result[f]);
  }
  return seen;
}

int ReadFrameCount(ExperimentContext& context) {
  return context.parameters.Integer("frames", context.full ? 600 : 120, 2);
}

void Study::Add(ExperimentContext& context, MethodRun run) {
  pairs.push_back(RunOverClips(context, run, scenarios));
  clips.push_back(MeasureAll(pairs.back()));
  auto& seen_clips = seen.emplace_back();
  for (size_t s = 0; s < scenarios.size(); ++s) {
    seen_clips.push_back(Measure(FramesWithPeople(scenarios[s], pairs.back()[s])));
  }
  methods.push_back(std::move(run));
}

std::vector<RecordedPair> RecordScenarios(ExperimentContext& context, const std::string& observer,
                                          const std::vector<recon::MotionClip>& clips, int frames) {
  std::vector<RecordedPair> recorded;
  RecordingSimulator simulator(context, observer);
  for (size_t i = 0; i < kScenarios; ++i) {
    const recon::MotionClip& clip = clips[i % clips.size()];
    const Scenario scenario = MakeScenario(i);
    SequenceOptions sequence;
    sequence.name = fmt::format("scenario {} ({})", i + 1, scenario.text);
    sequence.clutter = scenario.clutter;
    sequence.azimuth_rad = scenario.azimuth_rad;
    sequence.frames = frames;
    sequence.seed = context.seed * 100 + i;
    if (context.progress) {
      context.progress(static_cast<double>(i), kScenarios, "rendering " + sequence.name);
    }
    recorded.push_back(simulator.Record(clip, sequence));
  }
  return recorded;
}

Study RunStudy(ExperimentContext& context) {
  Study study;
  const std::string observer = ReadObserver(context.parameters);
  const int frames = ReadFrameCount(context);
  const auto motions = TenPerformances(context, frames);
  study.note = ObserverNote(observer) + motions.note;
  study.scenarios = RecordScenarios(context, observer, motions.clips, frames);
  for (const char* method : {"none", "shum-2013", "plantard-2016", "best"}) {
    MethodRun run{std::string(method) == "none" ? "raw" : method, {}, {}};
    run.options.method = method;
    run.options.database = LoadDatabase(context).postures;
    run.options.seed = context.seed;
    if (recon::RequireMethod(method).prior) {
      run.options.prior = LoadPrior(context);
      SetObserverCorrection(observer, &run);
    }
    study.Add(context, std::move(run));
  }
  study.Add(context, WithPhysics(study.methods[2]));
  return study;
}

std::optional<double> ShareOfJointsHidden(const recon::SkeletonSequence& truth) {
  double hidden = 0, joints = 0;
  for (const auto& frame : truth.frames) {
    for (const auto& joint : frame.bodies.at(0).joints) {
      hidden += joint && !joint->visible.value_or(true) ? 1 : 0;
      ++joints;
    }
  }
  return joints > 0 ? std::optional(hidden / joints) : std::nullopt;
}

std::optional<double> ShareOfFramesWithNobody(const recon::SkeletonSequence& observed) {
  const auto& frames = observed.frames;
  if (frames.empty()) return std::nullopt;
  const auto nobody = std::count_if(frames.begin(), frames.end(), IsWithoutJoints);
  return static_cast<double>(nobody) / static_cast<double>(frames.size());
}

Table ByScenario(const Study& study) {
  Table table;
  table.title = "The ten scenarios (table 1): eq. 13, cm, and frames over 20 cm, %";
  table.columns = {"scenario", "frames", "joints hidden, %", "nobody seen, %"};
  for (const MethodRun& run : study.methods) {
    table.columns.push_back(run.label + ", cm");
    table.columns.push_back(run.label + ", >20 cm");
  }
  for (size_t s = 0; s < study.scenarios.size(); ++s) {
    const RecordedPair& scenario = study.scenarios[s];
    std::vector<std::string> row = {scenario.clip, std::to_string(scenario.truth.frames.size()),
                                    Cell(ShareOfJointsHidden(scenario.truth), 1, 100),
                                    Cell(ShareOfFramesWithNobody(scenario.observed), 1, 100)};
    for (const auto& clips : study.clips) {
      row.push_back(Cell(clips[s].parent_relative_error_cm));
      row.push_back(Cell(clips[s].fraction_frames_over_20cm, 1, 100));
    }
    table.rows.push_back(row);
  }
  table.note = study.note + "Recordings begin when the person is found: no frames, never found. ";
  return table;
}

// Share of frames in each error band, or at least that wrong.
Table Histogram(const Study& study, const std::vector<size_t>& scenarios, bool cumulative,
                const std::string& title) {
  constexpr int kBand_cm = 5;  // figure 6
  constexpr int kBands = 8;    // figure 6
  Table table;
  table.title = title;
  table.columns = {"error, cm"};
  for (const MethodRun& run : study.methods) table.columns.push_back(run.label + ", %");
  std::vector<std::vector<double>> errors(study.methods.size());
  for (size_t m = 0; m < study.methods.size(); ++m) {
    for (const size_t s : scenarios) {
      for (const auto& error : ErrorsByFrame(study.pairs[m][s]).parent_relative_cm) {
        if (error) errors[m].push_back(*error);
      }
    }
  }
  for (int band = 0; band < kBands; ++band) {
    const double low = band * kBand_cm;
    const double high = low + kBand_cm;
    const bool last = band + 1 == kBands;
    std::vector<std::string> row = {cumulative || last ? fmt::format(">= {}", low)
                                                       : fmt::format("{}-{}", low, high)};
    for (const auto& values : errors) {
      const auto count = std::count_if(values.begin(), values.end(), [&](double value) {
        return value >= low && (cumulative || last || value < high);
      });
      row.push_back(
          values.empty()
              ? "-"
              : Cell(100.0 * static_cast<double>(count) / static_cast<double>(values.size()), 1));
    }
    table.rows.push_back(row);
  }
  return table;
}

void DrawCumulative(const ExperimentContext& context, const Study& study) {
  constexpr double kFarthest_cm = 40;  // figure 7
  std::vector<Series> series;
  for (size_t m = 0; m < study.methods.size(); ++m) {
    std::vector<double> errors;
    for (const PairedTracks& pair : study.pairs[m]) {
      for (const auto& error : ErrorsByFrame(pair).parent_relative_cm) {
        if (error) errors.push_back(*error);
      }
    }
    Series line{study.methods[m].label, {}, {}};
    for (int step = 0; step <= 80; ++step) {
      const double limit_cm = kFarthest_cm * step / 80;
      const auto over = std::count_if(errors.begin(), errors.end(),
                                      [&](double error) { return error > limit_cm; });
      line.x.push_back(limit_cm);
      line.y.push_back(100.0 * static_cast<double>(over) /
                       static_cast<double>(std::max<size_t>(1, errors.size())));
    }
    series.push_back(std::move(line));
  }
  AtomicFile file(context.out / "figure7.html");
  file.stream() << "<!doctype html><meta charset=\"utf-8\"><title>Figure 7</title>"
                << LinePlot(series, {"error, cm", "frames above, %", kFarthest_cm, 100.0});
  file.Commit();
}

}  // namespace

void ReadPlantard2016Parameters(ExperimentContext& context) {
  ReadObserver(context.parameters);
  ReadFrameCount(context);
  ReadMotions(context);
  ReadDatabaseMotion(context.parameters);
  ReadUsesPrior(context.parameters);
}

std::vector<Table> RunPlantard2016(ExperimentContext& context) {
  const Study study = RunStudy(context);
  std::vector<std::string> labels;
  for (const MethodRun& run : study.methods) labels.push_back(run.label);
  std::vector<size_t> all(kScenarios);
  for (size_t s = 0; s < kScenarios; ++s) all[s] = s;
  DrawCumulative(context, study);
  return {
      ByScenario(study),
      MakePlantard2016FigureFive(labels, study.clips, study.seen),
      MakePlantard2016Tests(labels, study.clips),
      Histogram(study, {7}, false, "Figure 6a: errors in scenario 8"),
      Histogram(study, {9}, false, "Figure 6b: errors in scenario 10"),
      Histogram(study, all, true, "Figure 7: frames at least this wrong (drawn in figure7.html)"),
      MakePlantard2016FigureEight(labels, study.pairs),
      MakePlantard2016FigureNine(context, study.methods[2],
                                 {study.scenarios.begin() + 3, study.scenarios.end()})};
}

}  // namespace ossa::tools
