// Ours: the papers assume a level camera. The error of each method with a tilted one, if the floor
// is known and if the vertical is estimated from the person.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "recon/methods/method_table.h"
#include "tools/experiments/papers/shum_2013_internal.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand unless stated otherwise.

constexpr std::array kTilts_deg = {0.0, 10.0, 20.0,
                                   27.0};  // the last: the largest tilt of a Kinect v1
constexpr size_t kSeenWhole_frames = 60;   // two seconds, then no legs

recon::SkeletonSequence Tilted(recon::SkeletonSequence sequence, double tilt_deg) {
  const Eigen::AngleAxisd tilt(-tilt_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitX());
  for (auto& frame : sequence.frames) {
    frame.floor.reset();
    for (auto& body : frame.bodies) {
      for (auto& joint : body.joints) {
        if (joint) joint->position_m = tilt * joint->position_m;
      }
    }
  }
  return sequence;
}

/// A horizontal floor through the lowest true joint, in the tilted camera's space.
void AddFloor(double tilt_deg, const recon::SkeletonSequence& truth,
              recon::SkeletonSequence* observed) {
  const double rad = tilt_deg * std::numbers::pi / 180.0;
  const Eigen::Vector3d up(0.0, std::cos(rad), -std::sin(rad));
  double lowest_m = std::numeric_limits<double>::infinity();
  for (const auto& frame : truth.frames) {
    for (const auto& body : frame.bodies) {
      for (const auto& joint : body.joints) {
        if (joint) lowest_m = std::min(lowest_m, up.dot(joint->position_m));
      }
    }
  }
  for (auto& frame : observed->frames) {
    frame.floor = Eigen::Vector4d(up.x(), up.y(), up.z(), -lowest_m);
  }
}

bool IsLeg(recon::Joint joint) {
  using recon::Joint;
  for (const Joint leg : {Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kFootLeft, Joint::kKneeRight,
                          Joint::kAnkleRight, Joint::kFootRight}) {
    if (joint == leg) return true;
  }
  return false;
}

void HideLegs(recon::SkeletonSequence* sequence) {
  for (size_t f = kSeenWhole_frames; f < sequence->frames.size(); ++f) {
    for (auto& body : sequence->frames[f].bodies) {
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        if (IsLeg(static_cast<recon::Joint>(j))) body.joints[j].reset();
      }
    }
  }
}

bool MustLearn(const MethodRun& run) {
  return recon::RequireMethod(run.options.method).learned == recon::Reads::kRequired;
}

/// All methods; those that must learn only if there are other clips.
std::vector<MethodRun> Methods(const Shum2013Study& study) {
  std::vector<MethodRun> runs;
  for (const recon::MethodInfo& method : recon::MethodTable()) {
    if (method.learned == recon::Reads::kRequired && study.clean.size() < 2) continue;
    MethodRun run = method.name == "best" ? study.best_of_truth : study.shum;
    run.label = run.options.method = method.name;
    runs.push_back(run);
  }
  return runs;
}

/// Methods learn with a level camera from all clips but the tested one.
MethodRun Prepared(const ExperimentContext& context, const Shum2013Study& study, MethodRun run,
                   size_t tested) {
  if (!MustLearn(run)) return run;
  std::vector<RecordedPair> others = study.clean;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(tested));
  run.options.learned_file = LearnWithout(context, others, "").string();
  return run;
}

std::optional<double> MeanError_cm(const ExperimentContext& context, const Shum2013Study& study,
                                   const MethodRun& run, double tilt_deg, bool with_floor) {
  std::vector<ClipMetrics> clips;
  for (size_t i = 0; i < study.clean.size(); ++i) {
    const RecordedPair& clip = study.clean[i];
    const auto truth = Tilted(clip.truth, tilt_deg);
    auto observed = Tilted(clip.observed, tilt_deg);
    if (with_floor) AddFloor(tilt_deg, truth, &observed);
    HideLegs(&observed);
    clips.push_back(MeasureClip(clip.clip, truth,
                                RunMethod(context, Prepared(context, study, run, i), observed)));
  }
  return Average(clips, &ClipMetrics::mean_joint_error_cm);
}

}  // namespace

Table TiltTable(const ExperimentContext& context, const Shum2013Study& study) {
  Table table;
  table.title = "Tilted camera, both legs hidden after two seconds: mean joint error, cm";
  table.columns = {"method", "which way is up"};
  for (const double tilt_deg : kTilts_deg) {
    table.columns.push_back(fmt::format("{:.0f} degrees", tilt_deg));
  }
  for (const MethodRun& run : Methods(study)) {
    for (const bool with_floor : {true, false}) {
      std::vector<std::string> row = {run.label, with_floor ? "by the floor" : "by the person"};
      for (const double tilt_deg : kTilts_deg) {
        row.push_back(Cell(MeanError_cm(context, study, run, tilt_deg, with_floor)));
      }
      table.rows.push_back(row);
    }
  }
  table.note =
      "The same joints seen by a camera that looks down by so much. The papers assume a level one. "
      "liu-2016, full-gp and exemplar learned before a level one, from the other clips.";
  return table;
}

}  // namespace ossa::tools
