#include <algorithm>
#include <cmath>

#include "depth/base/statistics.h"
#include "recon/methods/prepared_posture_internal.h"
#include "recon/methods/reach_internal.h"
#include "recon/placed_joint.h"

namespace ossa::recon {
namespace {

/// The standard stance two metres away: the result for a person of whom nothing was ever seen.
Posture StanceInCamera(const BoneLengths& lengths, double yaw_rad) {
  Placement placement{{0.0, 0.0, 2.0}, yaw_rad};
  Posture stance = StandardStance();
  const Eigen::Vector3d root = stance[Joint::kHipCenter];
  for (auto& p : stance.position_m) p -= root;
  return Placed(Retargeted(stance, lengths), placement);
}

/// Translation that aligns the model with the present joints: the median per coordinate.
Eigen::Vector3d OffsetTo(const Posture& model, const Posture& seen, const JointWeights& present) {
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> d;
    for (size_t i = 0; i < kJointCount; ++i) {
      if (present[i] > 0.0) d.push_back(seen.position_m[i][axis] - model.position_m[i][axis]);
    }
    if (d.empty()) return Eigen::Vector3d::Zero();
    offset[axis] = Median(std::move(d));
  }
  return offset;
}

/// Shum & Ho 2012 eqs. 3-4 with unseen joints: a joint whose parent is missing is placed relative
/// to its nearest present ancestor, at the observed distance scaled by the ratio of the bones
/// between. Departure: the paper works joint by joint, which would keep of a hand with a hidden arm
/// only the direction of its last bone from a guessed wrist.
Posture RetargetedAsSeen(const Posture& own, const JointWeights& present,
                         const BoneLengths& own_lengths) {
  const BoneLengths& standard = StandardBoneLengths();
  Posture out = Retargeted(own, standard);
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    size_t ancestor = parent;
    double chain_m = own_lengths[i], standard_chain_m = standard[i];
    while (ancestor != 0 && present[ancestor] == 0.0) {
      chain_m += own_lengths[ancestor];
      standard_chain_m += standard[ancestor];
      ancestor = ParentOf(ancestor);
    }
    if (present[i] == 0.0 || ancestor == parent || !(chain_m > 0.0)) {
      Eigen::Vector3d bone = own.position_m[i] - own.position_m[parent];
      if (bone.norm() < 1e-6)
        bone = StandardStance().position_m[i] - StandardStance().position_m[parent];
      out.position_m[i] = out.position_m[parent] + bone.normalized() * standard[i];
      continue;
    }
    const Eigen::Vector3d reach = own.position_m[i] - own.position_m[ancestor];
    out.position_m[i] = out.position_m[ancestor] + standard_chain_m / chain_m * reach;
  }
  return out;
}

void Interpolate(Posture& p, JointWeights& present, const InterpolatedJoint& line) {
  if (present[line.joint] > 0.0 || present[line.a] * present[line.b] == 0.0) return;
  p[line.joint] = (1.0 - line.share) * p[line.a] + line.share * p[line.b];
  present[line.joint] = 1.0;
}

}  // namespace

Posture Completed(const Posture& in_camera, const JointWeights& present_in, const Posture& model,
                  JointWeights* interpolated) {
  Posture out = in_camera;
  JointWeights present = present_in;
  const Eigen::Vector3d offset = OffsetTo(model, in_camera, present);
  for (const InterpolatedJoint& line : kInterpolatedJoints) Interpolate(out, present, line);
  for (size_t i = 0; interpolated != nullptr && i < kJointCount; ++i) {
    (*interpolated)[i] = present[i] - present_in[i];
  }
  if (IsTrunkUnseen(present)) {
    PlaceFromPresent(out, present, model);
    return out;
  }
  if (present[0] == 0.0) out.position_m[0] = model.position_m[0] + offset;
  for (size_t i = 1; i < kJointCount; ++i) {
    if (present[i] > 0.0) continue;
    const auto parent = ParentOf(i);
    out.position_m[i] = out.position_m[parent] + model.position_m[i] - model.position_m[parent];
  }
  return out;
}

JointWeights SeenJoints(const PreparedPosture& prepared) {
  JointWeights seen = prepared.present;
  for (size_t i = 0; i < kJointCount; ++i) seen[i] += prepared.interpolated[i];
  return seen;
}

BodySize Person::FreshSize() const {
  BodySize size;
  if (bones_m_) size.Know(*bones_m_);
  return size;
}

// In the first frame the model is a standing posture in the person's heading, so that sides are
// right for people seen from behind.
Posture Person::ModelOf(const Posture& seen, const JointWeights& present) const {
  if (last_in_camera_) return *last_in_camera_;
  return StanceInCamera(size_.lengths_m(), EstimatePlacement(seen, present, last_yaw_rad_).yaw_rad);
}

PreparedPosture Person::Prepare(const ReconstructionInput& input) {
  PreparedPosture out;
  const std::optional<double> step_s = steps_.To(input.time_s);
  out.restarted = !step_s;
  if (step_s) out.dt_s = std::max(*step_s, 0.005);
  if (out.restarted) {
    estimator_.ForgetMotion();  // displacements across a gap are not vibration
    if (!started_) size_ = FreshSize();
  }
  const Reliability r =
      estimator_.Step(input.observed, input.depth, out.dt_s, input.camera_from_observed);
  out.reliability = r.rate;
  out.terms = r;
  for (size_t i = 0; i < kJointCount; ++i) {
    const Eigen::Vector3d& p = input.observed.posture.position_m[i];
    const bool there = input.observed.state[i] != TrackingState::kNotTracked && IsPossiblePlace(p);
    out.present[i] = there ? 1.0 : 0.0;
    if (!there) out.reliability[i] = 0.0;
  }
  if (!size_.locked() || started_) size_.Observe(input.observed.posture, out.reliability);
  out.in_camera = Completed(input.observed.posture, out.present,
                            ModelOf(input.observed.posture, out.present), &out.interpolated);
  JointWeights heading = out.reliability;
  for (size_t i = 0; i < kJointCount; ++i) heading[i] += 0.1 * out.present[i];
  out.placement = EstimatePlacement(out.in_camera, heading, last_yaw_rad_);
  out.normalised =
      RetargetedAsSeen(Normalised(out.in_camera, out.placement), out.present, size_.lengths_m());
  out.scale = size_.scale();
  out.scaled = Scaled(Normalised(out.in_camera, out.placement), 1.0 / out.scale);
  started_ = true;
  return out;
}

Posture Person::InCamera(const Posture& normalised, const PreparedPosture& prepared) const {
  return Placed(Retargeted(normalised, size_.lengths_m()), prepared.placement);
}

void Person::Remember(const Posture& in_camera, const PreparedPosture& prepared) {
  last_in_camera_ = in_camera;
  last_yaw_rad_ = prepared.placement.yaw_rad;
}

void Person::Reset() {
  estimator_.Reset();
  size_ = FreshSize();
  last_in_camera_.reset();
  last_yaw_rad_ = M_PI;
  steps_ = {};
  started_ = false;
}

}  // namespace ossa::recon
