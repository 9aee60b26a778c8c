// Shum, Ho, Jiang, Takagi: Real-time posture reconstruction for Microsoft Kinect (2013): table IV;
// tables I and II are in shum_2013_data.cpp, table III in shum_2013_parts.cpp, figures 8 and 9 in
// shum_2013_sweeps.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/papers/database_coverage.h"
#include "tools/experiments/papers/shum_2013_internal.h"
#include "tools/experiments/papers/visibility_errors.h"
#include "tools/experiments/simulation/motions.h"

namespace ossa::tools {
namespace {

struct Class {
  const char* name;
  double paper_raw_cm;
  double paper_made_cm;
  const std::vector<RecordedPair>* clips;
};

std::array<Class, 3> Classes(const Shum2013Study& study) {
  return {{{"(a) un-occluded, self-occluded", 9.59, 7.26, &study.clean},
           {"(b) occluded by furniture", 10.89, 7.44, &study.furniture},
           {"(c) occluded by a held thing", 12.41, 7.76, &study.held}}};
}

Table TableFour(const ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title = "Table IV: accuracy of the whole system, eq. 18 against the truth";
  table.columns = {"class",
                   "clips",
                   "paper raw, cm",
                   "paper shum-2013, cm",
                   "paper gain, %",
                   "raw, cm",
                   "shum-ho-2012 (method A), cm",
                   "no reliability (B), cm",
                   "shum-2013 (C), cm",
                   "gain of C, %",
                   "C, reliable joints kept, cm",
                   "best, cm"};
  for (const Class& c : Classes(study)) {
    std::vector<std::string> row = {c.name, std::to_string(c.clips->size()), Cell(c.paper_raw_cm),
                                    Cell(c.paper_made_cm),
                                    Cell(100 * (1 - c.paper_made_cm / c.paper_raw_cm), 1)};
    std::optional<double> raw_cm;
    for (const MethodRun& run :
         {study.raw, study.method_a, study.method_b, study.shum, study.kept, study.best}) {
      const auto made = MeasureAll(RunOverClips(context, run, *c.clips));
      const auto mean = Average(made, &ClipMetrics::parent_relative_error_cm);
      if (run.label == study.raw.label) raw_cm = mean;
      row.push_back(MeanAndMedian(made, &ClipMetrics::parent_relative_error_cm));
      if (run.label != study.shum.label) continue;
      row.push_back(mean && raw_cm ? Cell(100 * (1 - *mean / *raw_cm), 1) : "-");
    }
    table.rows.push_back(row);
  }
  table.note = study.note +
               "Raw: method none, which holds a joint the observer does not give at its last "
               "place. Truth: the body's own joints, hidden ones too, where the paper has magnetic "
               "sensors; motions and things are not the paper's.";
  return table;
}

/// The papers end with the physical character; table IV has the methods alone.
Table TableFourWithPhysics(const ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title =
      "Table IV to the last stage: eq. 18 in cm, acceleration error in cm/frame², method alone -> "
      "+ physics";
  const std::array<const MethodRun*, 4> runs = {&study.method_a, &study.method_b, &study.shum,
                                                &study.best};
  table.columns = {"class"};
  for (const MethodRun* run : runs) {
    table.columns.push_back(run->label + ", eq. 18");
    table.columns.push_back(run->label + ", acceleration");
  }
  for (const Class& c : Classes(study)) {
    std::vector<std::string> row = {c.name};
    for (const MethodRun* run : runs) {
      const auto alone = MeasureAll(RunOverClips(context, *run, *c.clips));
      const auto last = MeasureAll(RunOverClips(context, WithPhysics(*run), *c.clips));
      for (const auto member : {&ClipMetrics::parent_relative_error_cm,
                                &ClipMetrics::acceleration_error_cm_per_frame2}) {
        row.push_back(Cell(Average(alone, member)) + " -> " + Cell(Average(last, member)));
      }
    }
    table.rows.push_back(row);
  }
  table.note = "The character of `ossa reconstruct --physics on`, on each frame's floor.";
  return table;
}

Table ByVisibility(const ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title =
      "Table IV by what the sensor saw: eq. 18 of bones seen at both ends / of the others";
  table.columns = {"class", "hidden bones, %"};
  const std::array<const MethodRun*, 6> runs = {&study.raw,  &study.method_a, &study.method_b,
                                                &study.shum, &study.kept,     &study.best};
  for (const MethodRun* run : runs) table.columns.push_back(run->label + ", cm");
  for (const Class& c : Classes(study)) {
    std::vector<std::string> row = {c.name, ""};
    for (const MethodRun* run : runs) {
      const auto errors = ErrorsByVisibility(*c.clips, RunOverClips(context, *run, *c.clips));
      row[1] = Cell(100 * errors.hidden_share, 1);
      row.push_back(Cell(errors.visible_cm) + " / " + Cell(errors.hidden_cm));
    }
    table.rows.push_back(row);
  }
  table.note =
      "The paper does not tell the two apart. Visible: the joint's surface is in the image.";
  return table;
}

/// Adds a table of the exercises of UI-PRMD if the recordings are present.
void AddCoverage(const ExperimentContext& context, std::vector<Table>& tables) {
  constexpr size_t kEveryNthClip = 13;  // by hand: the short form takes minutes
  if (!std::filesystem::exists(context.shared / "real" / "uiprmd_kinect_vicon")) return;
  std::vector<RecordedPair> some;
  auto all = LoadUiPrmd(context.shared, false);
  for (size_t i = 0; i < all.size(); i += kEveryNthClip) some.push_back(std::move(all[i]));
  tables.push_back(CoverageTable(*LoadDatabase(context).postures, some));
}

std::set<std::string> ReadParts(Parameters& parameters) {
  return parameters.Some("parts", {"data", "table-3", "table-4", "tilt", "ablations"});
}

}  // namespace

Shum2013Settings ReadShum2013Settings(ExperimentContext& context) {
  return {ReadObserver(context.parameters),
          context.parameters.Integer("clips", context.full ? 8 : 2, 1),
          context.parameters.Integer("frames", context.full ? 450 : 150, 2)};
}

void ReadShum2013Parameters(ExperimentContext& context) {
  ReadParts(context.parameters);
  ReadShum2013Settings(context);
  ReadMotions(context);
  ReadUsesPrior(context.parameters);
}

std::vector<Table> RunShum2013(ExperimentContext& context) {
  const auto parts = ReadParts(context.parameters);
  const bool occluded = parts.contains("table-4") || parts.contains("ablations");
  Shum2013Study study(context, occluded);
  std::vector<Table> tables;
  if (parts.contains("data")) {
    tables.push_back(TableOne(context));
    tables.push_back(TableTwo(study));
  }
  if (parts.contains("table-3")) {
    tables.push_back(TableThree(context, study));
    tables.push_back(ComputeTableThreeBounds(context, study));
  }
  if (parts.contains("table-4")) {
    tables.push_back(TableFour(context, study));
    tables.push_back(TableFourWithPhysics(context, study));
    tables.push_back(ByVisibility(context, study));
  }
  if (parts.contains("tilt")) tables.push_back(TiltTable(context, study));
  if (!parts.contains("ablations")) return tables;
  for (Table& table : MakeShum2013Sweeps(context, study)) tables.push_back(std::move(table));
  AddCoverage(context, tables);
  return tables;
}

Shum2013Study::Shum2013Study(ExperimentContext& context, bool occluded) {
  const auto settings = ReadShum2013Settings(context);
  RecordClips(context, settings, occluded);
  SetUpMethods(context, settings.observer);
}

void Shum2013Study::RecordClips(ExperimentContext& context, const Shum2013Settings& settings,
                                bool occluded) {
  const auto motions = StudyMotions(context, static_cast<size_t>(settings.clips), settings.frames);
  RecordingSimulator simulator(context, settings.observer);
  note = ObserverNote(settings.observer) + motions.note;
  const auto record = [&](Clutter clutter, const char* kind) {
    std::vector<RecordedPair> pairs;
    for (size_t i = 0; i < motions.clips.size(); ++i) {
      if (context.progress) {
        context.progress(static_cast<double>(i), static_cast<double>(motions.clips.size()),
                         fmt::format("rendering {} {}", kind, motions.clips[i].name));
      }
      SequenceOptions sequence;
      sequence.name = fmt::format("{} {}", motions.clips[i].name, kind);
      sequence.clutter = clutter;
      sequence.frames = settings.frames;
      sequence.seed = context.seed * 100 + i;
      pairs.push_back(simulator.Record(motions.clips[i], sequence));
    }
    return pairs;
  };
  clean = record(Clutter::kNone, "clean");
  if (occluded) {
    furniture = record(Clutter::kFurniture, "furniture");
    held = record(Clutter::kHeld, "held");
  }
}

void Shum2013Study::SetUpMethods(ExperimentContext& context, const std::string& observer) {
  const auto method = [&](const char* label, const char* name) {
    MethodRun run{label, {}, {}};
    run.options.method = name;
    run.options.database = LoadDatabase(context).postures;
    run.options.seed = context.seed;
    return run;
  };
  raw = method("raw", "none");
  method_a = method("method A", "shum-ho-2012");
  method_b = method("method B", "shum-2013");
  method_b.options.local_pca.use_reliability = false;
  shum = method("shum-2013", "shum-2013");
  kept = method("shum-2013, reliable kept", "shum-2013");
  kept.options.local_pca.keep_reliable = true;
  best = method("best", "best");
  best.options.prior = LoadPrior(context);
  best_of_truth = best;
  SetObserverCorrection(observer, &best);
}

}  // namespace ossa::tools
