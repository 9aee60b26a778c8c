// Shum 2013, table III: reconstruction from subsets of parts, and lower bounds of its errors.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <optional>

#include "recon/normalise.h"
#include "tools/experiments/papers/shum_2013_bound.h"
#include "tools/experiments/papers/shum_2013_internal.h"

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

/// Turns every posture about its hips to face the sensor: the paper removes position and heading
/// first (sec. V-A), so that they are known in every setup.
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

/// Keeps the parts of a setup and the root. The first frame keeps all joints: the reference posture
/// at the start of tracking, which determines the bone lengths (sec. IV-B).
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

}  // namespace

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

namespace {

std::string Limbs(const Eigen::Vector3d& limbs_cm) {
  return fmt::format("{:.2f} / {:.2f} / {:.2f}", limbs_cm[0], limbs_cm[1], limbs_cm[2]);
}

/// Sums over the clips of one setup of table III.
struct SetupBound {
  int clips = 0;
  double nearest_cm = 0.0, by_parts_cm = 0.0;
  Eigen::Vector3d limbs_cm = Eigen::Vector3d::Zero();  // trunk, arms, legs
  double worst_cm = 0.0;                               // sum over the limbs of the worst clip
  std::string worst = "-";

  void Add(const DatabaseBound& bound, const Eigen::Vector3d& clip_cm, const std::string& clip) {
    ++clips;
    nearest_cm += bound.nearest_cm;
    by_parts_cm += bound.by_parts_cm;
    limbs_cm += clip_cm;
    if (clip_cm.sum() < worst_cm) return;
    worst_cm = clip_cm.sum();
    worst = fmt::format("{} ({})", Limbs(clip_cm), clip);
  }
  std::optional<double> Mean(double sum_cm) const {
    return clips > 0 ? std::optional(sum_cm / clips) : std::nullopt;
  }
};

SetupBound ComputeSetupBound(const ExperimentContext& context, const Shum2013Study& study,
                             const Setup& setup) {
  SetupBound sum;
  for (const RecordedPair& clip : study.clean) {
    const auto truth = Facing(clip.truth);
    const auto bound = ComputeBound(*LoadDatabase(context).postures, truth, setup.used);
    if (!bound) continue;
    const auto made = RunMethod(context, study.best_of_truth, Only(truth, setup.used));
    sum.Add(*bound, ErrorByLimbs_cm(truth, made), clip.clip);
  }
  return sum;
}

}  // namespace

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
    const SetupBound sum = ComputeSetupBound(context, study, setup);
    table.rows.push_back({setup.name, Cell(setup.paper_cm), Cell(sum.Mean(sum.nearest_cm)),
                          Cell(sum.Mean(sum.by_parts_cm)),
                          sum.clips > 0 ? Limbs(sum.limbs_cm / sum.clips) : "-", sum.worst});
  }
  table.note =
      "Nearest to the truth: nothing hidden, on the true bones; what shows one posture of the "
      "database cannot be better in any setup. Nearest by the parts: of all postures the one whose "
      "hands (and so on) are nearest to the true ones.";
  return table;
}

}  // namespace ossa::tools
