#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/body/parts.h"
#include "recon/body/standard_body.h"
#include "recon/refine/free_space.h"
#include "tools/tracker/choose_posture_internal.h"

namespace ossa::tracker {
namespace {

using forest::Proposal;
using recon::kJointCount;

double BoneCost(double length_m, double expected_m, const ChoiceOptions& options) {
  const double sigma_m = options.bone_m + options.bone_share * expected_m;
  const double off = (length_m - expected_m) / sigma_m;
  return std::min(0.5 * off * off, options.worst_bone);
}

struct Option {
  const Proposal* proposal = nullptr;  // null: missing
  double cost = 0;  // its own cost plus those of the best choices of all descendants
  recon::JointArray<int> child_choice{};
};

// Exact minimum over the tree of joints by dynamic programming, children before parents (Viterbi).
class Chooser {
 public:
  Chooser(const std::vector<std::vector<Proposal>>& proposals, const people::JointTargets& targets,
          const ChoiceContext& context)
      : context_(context) {
    for (size_t j = 0; j < kJointCount; ++j) {
      AddOptions(j, proposals[static_cast<size_t>(targets[j])]);
    }
    for (size_t j = kJointCount - 1; j > 0; --j) PassToParent(j);
  }

  recon::JointArray<const Proposal*> Best() const {
    recon::JointArray<const Proposal*> chosen{};
    recon::JointArray<int> index{};
    const auto& roots = options_[0];
    index[0] = static_cast<int>(
        std::min_element(roots.begin(), roots.end(),
                         [](const Option& a, const Option& b) { return a.cost < b.cost; }) -
        roots.begin());
    for (size_t j = 0; j < kJointCount; ++j) {
      if (j > 0) {
        const size_t p = recon::ParentOf(j);
        index[j] = options_[p][static_cast<size_t>(index[p])].child_choice[j];
      }
      chosen[j] = options_[j][static_cast<size_t>(index[j])].proposal;
    }
    return chosen;
  }

 private:
  void AddOptions(size_t joint, const std::vector<Proposal>& modes) {
    auto& options = options_[joint];
    options.push_back({nullptr, context_.options.missing_cost, {}});
    for (const Proposal& mode : modes) {
      if (options.size() > context_.options.modes || !mode.position_m.allFinite()) break;
      double cost = -std::log(std::max(mode.confidence, 1e-3));
      if (context_.before != nullptr &&
          context_.before->state[joint] == recon::TrackingState::kTracked) {
        const double jump = (mode.position_m - context_.before->posture.position_m[joint]).norm();
        cost += std::min(0.5 * std::pow(jump / context_.options.jump_m, 2),
                         context_.options.worst_jump);
      }
      options.push_back({&mode, cost, {}});
    }
  }

  void PassToParent(size_t j) {
    for (Option& parent : options_[recon::ParentOf(j)]) {
      double best = std::numeric_limits<double>::infinity();
      for (size_t i = 0; i < options_[j].size(); ++i) {
        const Option& child = options_[j][i];
        double cost = child.cost;
        if (child.proposal != nullptr && parent.proposal != nullptr) {
          cost += BoneCost((child.proposal->position_m - parent.proposal->position_m).norm(),
                           context_.expected_m[j], context_.options);
        }
        if (cost < best) best = cost, parent.child_choice[j] = static_cast<int>(i);
      }
      parent.cost += best;
    }
  }

  const ChoiceContext& context_;
  recon::JointArray<std::vector<Option>> options_;
};

recon::TrackingState DecideState(const Proposal& proposal, const forest::ProposalTarget& target,
                                 const depth::Camera& camera) {
  if (proposal.confidence < static_cast<double>(target.inferred_confidence)) {
    return recon::TrackingState::kNotTracked;
  }
  const bool tracked = proposal.seen && IsInImage(camera, proposal.position_m) &&
                       proposal.confidence >= static_cast<double>(target.tracked_confidence);
  return tracked ? recon::TrackingState::kTracked : recon::TrackingState::kInferred;
}

// If a joint and its mirrored one (hands, knees) are at one place, the less confident one becomes
// inferred.
void InferDuplicates(double one_place_m, recon::TrackedPosture& posture) {
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto m = recon::kMirroredJoint[j];
    if (m <= j || posture.state[j] == recon::TrackingState::kNotTracked ||
        posture.state[m] == recon::TrackingState::kNotTracked) {
      continue;
    }
    if ((posture.posture.position_m[j] - posture.posture.position_m[m]).norm() > one_place_m)
      continue;
    const size_t weaker = posture.confidence[j] < posture.confidence[m] ? j : m;
    posture.state[weaker] = recon::TrackingState::kInferred;
  }
}

// Hips count as seen only with visible thighs. For a body cut off at the waist, by the image or a
// table, the forest infers the hips with high confidence.
void InferHipsWithoutLegs(const ChoiceContext& context, recon::TrackedPosture& posture) {
  if (context.leg_area_m2 >= context.options.thigh_m2) return;
  for (size_t j = 0; j < kJointCount; ++j) {
    const bool lower = j == 0 || j >= recon::Index(recon::Joint::kHipLeft);
    if (lower && posture.state[j] == recon::TrackingState::kTracked)
      posture.state[j] = recon::TrackingState::kInferred;
  }
}

}  // namespace

bool IsInImage(const depth::Camera& camera, const Eigen::Vector3d& place_m) {
  if (!(place_m.z() > 0.05)) return false;
  const Eigen::Vector2d pixel = depth::Project(camera, place_m);
  return pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() < camera.width && pixel.y() < camera.height;
}

recon::TrackedPosture ChoosePosture(const forest::ForestModel& model,
                                    const people::JointTargets& targets,
                                    const std::vector<std::vector<Proposal>>& proposals,
                                    const ChoiceContext& context) {
  const auto chosen = Chooser(proposals, targets, context).Best();
  recon::TrackedPosture result;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (chosen[j] == nullptr) continue;
    const auto& target = model.targets()[static_cast<size_t>(targets[j])];
    result.posture.position_m[j] = chosen[j]->position_m;
    result.confidence[j] = chosen[j]->confidence;
    result.state[j] = DecideState(*chosen[j], target, *context.camera);
  }
  InferDuplicates(context.options.one_place_m, result);
  InferHipsWithoutLegs(context, result);
  return result;
}

void InferElsewhere(const recon::Posture& said_m, const depth::Camera& camera, double elsewhere_m,
                    recon::TrackedPosture& seen) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (seen.state[j] != recon::TrackingState::kTracked) continue;
    const Eigen::Vector3d& place_m = said_m.position_m[j];
    const bool is_there = (place_m - seen.posture.position_m[j]).norm() <= elsewhere_m;
    if (!is_there || !IsInImage(camera, place_m)) seen.state[j] = recon::TrackingState::kInferred;
  }
}

void InferSeenThrough(const recon::Posture& said_m, const depth::DepthFrame& frame,
                      recon::TrackedPosture& seen) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (seen.state[j] == recon::TrackingState::kTracked &&
        recon::IsInFreeSpace(said_m.position_m[j], frame)) {
      seen.state[j] = recon::TrackingState::kInferred;
    }
  }
}

recon::BoneLengths AverageBoneLengths() {
  return recon::MeasureBoneLengths(recon::StandardPosture(recon::RigPose{}));
}

void LearnBoneLengths(const recon::TrackedPosture& observed, recon::BoneLengths& lengths_m,
                      const ChoiceOptions& options) {
  const recon::BoneLengths average = AverageBoneLengths();
  const recon::BoneLengths seen = recon::MeasureBoneLengths(observed.posture);
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    if (observed.state[j] != recon::TrackingState::kTracked ||
        observed.state[parent] != recon::TrackingState::kTracked) {
      continue;
    }
    const double next = lengths_m[j] + (seen[j] - lengths_m[j]) / options.learning_frames;
    lengths_m[j] = std::clamp(next, options.shortest * average[j], options.longest * average[j]);
  }
}

}  // namespace ossa::tracker
