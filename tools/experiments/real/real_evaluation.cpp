// Stills with truth: joints of each stage of the tracker and their errors.
#include "tools/experiments/real/real_evaluation_internal.h"

#include <limits>

#include "depth/base/statistics.h"
#include "depth/image/camera.h"

namespace ossa::tools {
namespace {

// Minimum number of stills for a constant offset. By hand: the median of two is their mean.
constexpr size_t kLeastForOffset = 3;

std::optional<Eigen::Vector3d> ErrorAgainst(const RealTruth& truth, const depth::Camera& camera,
                                            const std::optional<Eigen::Vector3d>& estimate_m) {
  if (!estimate_m || estimate_m->z() <= 0) return std::nullopt;
  if (truth.position_m) return *estimate_m - *truth.position_m;
  if (!truth.pixel) return std::nullopt;
  const Eigen::Vector2d off_px = depth::Project(camera, *estimate_m) - *truth.pixel;
  const double z = estimate_m->z();
  return Eigen::Vector3d(-off_px.x() * z / camera.fx, -off_px.y() * z / camera.fy, 0.0);
}

JointErrors ErrorsOfBody(const RealSet& set, const RealStill& still, const StageJoints& joints) {
  JointErrors errors;
  for (size_t j = 0; j < set.joints.size(); ++j) {
    errors.push_back(
        ErrorAgainst(still.truth[j], still.frame.camera, joints[recon::Index(set.joints[j])]));
  }
  return errors;
}

double MeanLength(const JointErrors& errors) {
  double sum = 0;
  int count = 0;
  for (const auto& error : errors) {
    if (error) sum += error->norm(), ++count;
  }
  return count == 0 ? std::numeric_limits<double>::infinity() : sum / count;
}

// The constant offset of joint `j` for still `i`, from the stills that may be used; empty if there
// are too few.
std::optional<Eigen::Vector3d> OffsetFor(const RealSet& set,
                                         const std::vector<StillResult>& results, RealStage stage,
                                         size_t i, size_t j) {
  std::array<std::vector<double>, 3> axes;
  for (size_t k = 0; k < results.size(); ++k) {
    if (set.offsets_from_other_half && k % 2 == i % 2) continue;
    const auto errors = results[k].errors.find(stage);
    if (errors == results[k].errors.end() || !errors->second[j]) continue;
    for (size_t a = 0; a < 3; ++a) {
      axes[a].push_back((*errors->second[j])[static_cast<Eigen::Index>(a)]);
    }
  }
  if (axes[0].size() < kLeastForOffset) return std::nullopt;
  return Eigen::Vector3d(ossa::Median(axes[0]), ossa::Median(axes[1]), ossa::Median(axes[2]));
}

// The error minus the offset; sets `removed` if there is an offset.
Eigen::Vector3d WithoutOffset(const Eigen::Vector3d& error_m,
                              const std::optional<Eigen::Vector3d>& offset_m, bool& removed) {
  removed = removed || offset_m;
  return offset_m ? Eigen::Vector3d(error_m - *offset_m) : error_m;
}

struct JointTally {
  int64_t joints = 0, within_10cm = 0;
};

}  // namespace

std::string_view StageName(RealStage stage) {
  switch (stage) {
    case RealStage::kRaw:
      return "raw";
    case RealStage::kRefined:
      return "refined";
    case RealStage::kFinal:
      return "final";
    case RealStage::kPeer:
      return "peer";
  }
  return "";
}

StillResult EvaluateStill(const RealSet& set, const RealStill& still, tracker::Tracker& tracker) {
  StillResult result;
  for (const RealTruth& truth : still.truth) {
    result.has_truth.push_back(truth.position_m || truth.pixel);
  }
  tracker.Reset();
  const tracker::BodyFrame answer = tracker.Track(still.frame);
  result.bodies = answer.bodies.size();
  result.fit_ms = answer.ms.fit;
  double nearest = std::numeric_limits<double>::infinity();
  for (const tracker::Body& body : answer.bodies) {
    const JointErrors raw = ErrorsOfBody(set, still, JointsAtStage(body, RealStage::kRaw));
    if (!(MeanLength(raw) < nearest)) continue;
    nearest = MeanLength(raw);
    result.fit = body.fit;
    result.tracked.clear();
    for (const recon::Joint joint : set.joints) {
      result.tracked.push_back(body.joints[recon::Index(joint)].state ==
                               recon::TrackingState::kTracked);
    }
    for (const RealStage stage : kRealStages) {
      result.errors[stage] = ErrorsOfBody(set, still, JointsAtStage(body, stage));
    }
  }
  if (!still.peer_m.empty()) {
    JointErrors& errors = result.errors[RealStage::kPeer];
    for (size_t j = 0; j < set.joints.size(); ++j) {
      errors.push_back(ErrorAgainst(still.truth[j], still.frame.camera, still.peer_m[j]));
    }
  }
  return result;
}

std::optional<Eigen::Vector3d> ErrorWithoutOffset(const RealSet& set,
                                                  const std::vector<StillResult>& results,
                                                  RealStage stage, size_t i, size_t j) {
  const auto errors = results[i].errors.find(stage);
  if (errors == results[i].errors.end() || !errors->second[j]) return std::nullopt;
  const auto offset_m = OffsetFor(set, results, stage, i, j);
  if (!offset_m) return std::nullopt;
  return *errors->second[j] - *offset_m;
}

StateScore ScoreStates(const RealSet& set, const std::vector<StillResult>& results) {
  StateScore score;
  for (size_t i = 0; i < results.size(); ++i) {
    const auto errors = results[i].errors.find(RealStage::kFinal);
    if (errors == results[i].errors.end()) continue;
    for (size_t j = 0; j < set.joints.size(); ++j) {
      if (!results[i].has_truth[j] || !errors->second[j]) continue;
      const Eigen::Vector3d error_m =
          WithoutOffset(*errors->second[j], OffsetFor(set, results, RealStage::kFinal, i, j),
                        score.offset_removed);
      const bool is_near = error_m.norm() <= kNearTruth_m;
      const bool tracked = results[i].tracked[j];
      ++(tracked ? score.tracked : score.others);
      (tracked ? score.tracked_within_10cm : score.others_within_10cm) += is_near ? 1 : 0;
    }
  }
  return score;
}

RawAndFinal ScoreRawAndFinal(const RealSet& set, const std::vector<StillResult>& results) {
  RawAndFinal score;
  for (size_t i = 0; i < results.size(); ++i) {
    const auto raw = results[i].errors.find(RealStage::kRaw);
    const auto final = results[i].errors.find(RealStage::kFinal);
    if (raw == results[i].errors.end() || final == results[i].errors.end()) continue;
    for (size_t j = 0; j < set.joints.size(); ++j) {
      if (!raw->second[j] || !final->second[j]) continue;
      const auto off_cm = [&](RealStage stage, const Eigen::Vector3d& error_m) {
        return 100 *
               WithoutOffset(error_m, OffsetFor(set, results, stage, i, j), score.offset_removed)
                   .norm();
      };
      ++score.joints;
      score.raw_cm += off_cm(RealStage::kRaw, *raw->second[j]);
      score.final_cm += off_cm(RealStage::kFinal, *final->second[j]);
    }
  }
  if (score.joints == 0) return score;
  score.raw_cm /= static_cast<double>(score.joints);
  score.final_cm /= static_cast<double>(score.joints);
  return score;
}

StageScore ScoreStage(const RealSet& set, const std::vector<StillResult>& results, RealStage stage,
                      bool remove_offset, const std::vector<bool>& counted) {
  StageScore score;
  score.stage = stage;
  std::map<std::string, JointTally> tallies;
  double sum_m = 0;
  int64_t within_5cm = 0, within_10cm = 0;
  for (size_t i = 0; i < results.size(); ++i) {
    const auto errors = results[i].errors.find(stage);
    for (size_t j = 0; j < set.joints.size(); ++j) {
      if (!counted[j] || !results[i].has_truth[j]) continue;
      JointTally& tally = tallies[set.joint_names[j]];
      ++score.joints, ++tally.joints;
      if (errors == results[i].errors.end() || !errors->second[j]) continue;
      Eigen::Vector3d error_m = *errors->second[j];
      if (remove_offset) {
        error_m =
            WithoutOffset(error_m, OffsetFor(set, results, stage, i, j), score.offset_removed);
      }
      const double distance_m = error_m.norm();
      ++score.found;
      sum_m += distance_m;
      within_5cm += distance_m <= 0.05;
      within_10cm += distance_m <= kNearTruth_m;
      tally.within_10cm += distance_m <= kNearTruth_m;
    }
  }
  const auto share = [](int64_t part, int64_t whole) {
    return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
  };
  if (score.found > 0) score.mean_cm = 100 * sum_m / static_cast<double>(score.found);
  score.within_5cm = share(within_5cm, score.joints);
  score.within_10cm = share(within_10cm, score.joints);
  for (const auto& [name, tally] : tallies) {
    score.per_joint_10cm[name] = share(tally.within_10cm, tally.joints);
  }
  return score;
}

}  // namespace ossa::tools
