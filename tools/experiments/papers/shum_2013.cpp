// Shum, Ho, Jiang, Takagi: Real-time posture reconstruction for Microsoft Kinect (2013): tables III
// and IV; tables I and II are in shum_2013_data.cpp, figures 8 and 9 in shum_2013_sweeps.cpp.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>

#include "recon/normalise.h"
#include "tools/experiments/experiments_internal.h"
#include "tools/experiments/papers/database_coverage.h"
#include "tools/experiments/papers/shum_2013_bound.h"
#include "tools/experiments/papers/shum_2013_internal.h"
#include "tools/experiments/papers/visibility_errors.h"
#include "tools/experiments/stage/motions.h"

namespace ossa::tools {
namespace {

using recon::Joint;

struct Setup {
  const char* name;
  double paper_cm;
  std::vector<Joint> used;
};

// Table III.
std::vector<Setup> Setups() {
  std::vector<Joint> all;
  for (size_t j = 0; j < recon::kJointCount; ++j) all.push_back(static_cast<Joint>(j));
  return {{"(a) left hand, left foot", 6.38, {Joint::kHandLeft, Joint::kFootLeft}},
          {"(b) hands", 5.60, {Joint::kHandLeft, Joint::kHandRight}},
          {"(c) hands, feet",
           4.52,
           {Joint::kHandLeft, Joint::kHandRight, Joint::kFootLeft, Joint::kFootRight}},
          {"(d) hands, feet, elbows, knees",
           4.15,
           {Joint::kHandLeft, Joint::kHandRight, Joint::kFootLeft, Joint::kFootRight,
            Joint::kElbowLeft, Joint::kElbowRight, Joint::kKneeLeft, Joint::kKneeRight}},
          {"(e) all parts", 3.90, std::move(all)}};
}

/// Every posture turned to face the sensor, about its hips: the paper removes place and heading
/// before it looks at any part (sec. V-A), so that they are known in every setup.
recon::SkeletonSequence Facing(recon::SkeletonSequence sequence) {
  recon::JointWeights all;
  all.fill(1.0);
  double yaw_rad = std::numbers::pi;
  for (auto& frame : sequence.frames) {
    for (auto& body : frame.bodies) {
      const recon::Posture posture = recon::ToTrackedPosture(body).posture;
      recon::Placement placement = recon::EstimatePlacement(posture, all, yaw_rad);
      yaw_rad = placement.yaw_rad;
      const recon::Posture own = recon::Normalised(posture, placement);
      placement.yaw_rad = std::numbers::pi;
      const recon::Posture turned = recon::Placed(own, placement);
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        if (body.joints[j]) body.joints[j]->position_m = turned.position_m[j];
      }
    }
  }
  return sequence;
}

/// Keeps the parts of a setup and the root; the first frame keeps all of them: the reference
/// posture that Kinect's tracking begins with, which fixes the person's bones (sec. IV-B).
recon::SkeletonSequence Only(recon::SkeletonSequence sequence, std::vector<Joint> used) {
  used.push_back(Joint::kHipCenter);
  for (size_t f = 1; f < sequence.frames.size(); ++f) {
    for (auto& body : sequence.frames[f].bodies) {
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        const bool kept = std::find(used.begin(), used.end(), static_cast<Joint>(j)) != used.end();
        if (!kept) body.joints[j].reset();
      }
    }
  }
  return sequence;
}

Table TableThree(const ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title = "Table III: reconstruction from subsets of parts, eq. 18 against the raw postures";
  table.columns = {"setup", "paper, cm", "shum-2013, cm", "best, cm"};
  for (const Setup& setup : Setups()) {
    std::vector<std::string> row = {setup.name, Cell(setup.paper_cm)};
    for (const MethodRun& run : {study.shum, study.best_of_truth}) {
      std::vector<ClipMetrics> clips;
      for (const RecordedPair& clip : study.clean) {
        const auto truth = Facing(clip.truth);
        const auto made = RunMethod(context, run, Only(truth, setup.used));
        clips.push_back(MeasureClip(clip.clip, truth, made));
      }
      row.push_back(MeanAndMedian(clips, &ClipMetrics::parent_relative_error_cm));
    }
    table.rows.push_back(row);
  }
  table.note =
      std::to_string(study.clean.size()) +
      " clips. The paper reconstructs 20 s of Kinect data recorded with as little tracking error "
      "as could "
      "be; here the clips' true joints stand for them. Place, heading and the first frame are "
      "given in every setup. Of three clips and more: mean (median).";
  return table;
}

std::string Limbs(const Eigen::Vector3d& limbs_cm) {
  return fmt::format("{:.2f} / {:.2f} / {:.2f}", limbs_cm[0], limbs_cm[1], limbs_cm[2]);
}

/// Explains table III: the error of the best single posture of the database, and the limbs with the
/// largest errors of best.
Table ComputeTableThreeBounds(const ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title = "Table III: what the database can give, true bones, and where best errs, eq. 18";
  table.columns = {"setup",
                   "paper, cm",
                   "nearest posture to the truth, cm",
                   "nearest by the parts, cm",
                   "best: trunk / arms / legs, cm",
                   "of its worst clip, cm"};
  for (const Setup& setup : Setups()) {
    double nearest_cm = 0.0, by_parts_cm = 0.0, clips = 0.0;
    Eigen::Vector3d limbs_cm = Eigen::Vector3d::Zero();
    std::string worst = "-";
    double worst_cm = 0.0;
    for (const RecordedPair& clip : study.clean) {
      const auto truth = Facing(clip.truth);
      const auto bound = ComputeBound(*LoadDatabase(context).postures, truth, setup.used);
      if (!bound) continue;
      ++clips;
      nearest_cm += bound->nearest_cm;
      by_parts_cm += bound->by_parts_cm;
      const auto made = RunMethod(context, study.best_of_truth, Only(truth, setup.used));
      const Eigen::Vector3d clip_cm = ErrorByLimbs_cm(truth, made);
      limbs_cm += clip_cm;
      if (clip_cm.sum() < worst_cm) continue;
      worst_cm = clip_cm.sum();
      worst = fmt::format("{} ({})", Limbs(clip_cm), clip.clip);
    }
    const auto mean = [clips](double sum_cm) {
      return clips > 0.0 ? std::optional(sum_cm / clips) : std::nullopt;
    };
    table.rows.push_back({setup.name, Cell(setup.paper_cm), Cell(mean(nearest_cm)),
                          Cell(mean(by_parts_cm)), clips > 0.0 ? Limbs(limbs_cm / clips) : "-",
                          worst});
  }
  table.note =
      "Nearest to the truth: nothing hidden, on the true bones; what shows one posture of the "
      "database cannot be better in any setup. Nearest by the parts: of all postures the one whose "
      "hands (and so on) are nearest to the true ones.";
  return table;
}

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

/// The papers end with the physical character; table IV is of the methods alone.
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

/// Of the exercises of UI-PRMD; no table without the recordings.
void AddCoverage(const ExperimentContext& context, std::vector<Table>& tables) {
  constexpr size_t kEveryNthClip = 13;  // by hand: what takes minutes in the short form
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
  const auto motions = StudyMotions(context, static_cast<size_t>(settings.clips), settings.frames);
  Studio studio(context, settings.observer);
  note = ObserverNote(settings.observer) + motions.note;
  const auto film = [&](Clutter clutter, const char* kind) {
    std::vector<RecordedPair> pairs;
    for (size_t i = 0; i < motions.clips.size(); ++i) {
      if (context.progress) {
        context.progress(static_cast<double>(i), static_cast<double>(motions.clips.size()),
                         fmt::format("filming {} {}", kind, motions.clips[i].name));
      }
      StageOptions stage;
      stage.name = fmt::format("{} {}", motions.clips[i].name, kind);
      stage.clutter = clutter;
      stage.frames = settings.frames;
      stage.seed = context.seed * 100 + i;
      pairs.push_back(studio.Record(motions.clips[i], stage));
    }
    return pairs;
  };
  clean = film(Clutter::kNone, "clean");
  if (occluded) {
    furniture = film(Clutter::kFurniture, "furniture");
    held = film(Clutter::kHeld, "held");
  }
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
  SetObserverCorrection(settings.observer, &best);
}

}  // namespace ossa::tools
