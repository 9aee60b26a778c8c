#include <algorithm>
#include <optional>

#include "recon/body/standard_body.h"
#include "recon/motion/bvh_layout_internal.h"
#include "recon/motion/held_body_internal.h"
#include "recon/t_pose.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

BoneLengths ComputeMedianLengths(const SightingLog& sightings) {
  constexpr double kShortest_m = 1e-3;  // shorter bones have no direction in the file; by hand
  BoneLengthEstimator estimator(BoneLengthOptions::ForWholeRecording());
  estimator.Start(MeasureBoneLengths(StandardPosture(RigPose())));
  for (size_t i = 0; i < sightings.size(); ++i) {
    const Sighting s = sightings[i];
    for (size_t j = 1; j < kJointCount; ++j) {
      const auto &end = s.joint[j], &begin = s.joint[ParentOf(j)];
      if (end && begin) estimator.Add(j, (*end - *begin).norm());
    }
  }
  BoneLengths lengths = estimator.lengths_m();
  for (size_t j = 1; j < kJointCount; ++j) lengths[j] = std::max(lengths[j], kShortest_m);
  return lengths;
}

/// Updates bone directions from a frame; missing ones are kept.
void UpdateDirections(const Sighting& sighting, JointArray<Vector3d>& direction) {
  for (size_t j = 1; j < kJointCount; ++j) {
    const auto& from = sighting.joint[ParentOf(j)];
    const auto& to = sighting.joint[j];
    if (from && to && (*to - *from).norm() > 1e-4) direction[j] = (*to - *from).normalized();
  }
}

/// The root position that brings the body of constant lengths nearest to the joints seen.
std::optional<Vector3d> EstimateRoot(const Sighting& sighting, const BoneLengths& lengths,
                                     const JointArray<Vector3d>& direction) {
  JointArray<Vector3d> built;
  built[0] = Vector3d::Zero();
  Vector3d sum = Vector3d::Zero();
  int seen = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (j > 0) built[j] = built[ParentOf(j)] + lengths[j] * direction[j];
    if (!sighting.joint[j]) continue;
    sum += *sighting.joint[j] - built[j];
    ++seen;
  }
  if (seen == 0) return std::nullopt;
  return sum / seen;
}

}  // namespace

HeldBody::HeldBody(const SightingLog& seen) : lengths_m_(ComputeMedianLengths(seen)) {
  for (size_t j = 0; j < kJointCount; ++j) direction_[j] = TPoseDirection(j);
  for (size_t i = seen.size(); i-- > 0;) Update(seen[i]);
}

void HeldBody::Update(const Sighting& sighting) {
  UpdateDirections(sighting, direction_);
  root_m_ = EstimateRoot(sighting, lengths_m_, direction_).value_or(root_m_);
}

Posture HeldBody::WholePosture(const Sighting& sighting) const {
  Posture whole;
  for (size_t j = 0; j < kJointCount; ++j) {
    const Vector3d at_bone_end =
        j == 0 ? root_m_ : Vector3d(whole.position_m[ParentOf(j)] + lengths_m_[j] * direction_[j]);
    whole.position_m[j] = sighting.joint[j].value_or(at_bone_end);
  }
  return whole;
}

}  // namespace ossa::recon
