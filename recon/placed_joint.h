#pragma once
#include <algorithm>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Whether a sensor can see a joint at this position of camera space: finite, and nearer than any
/// sensor's range.
inline bool IsPossiblePlace(const Eigen::Vector3d& position_m) {
  constexpr double kFarthest_m = 100.0;  // by hand, a bound
  return position_m.allFinite() && position_m.cwiseAbs().maxCoeff() < kFarthest_m;
}

/// Whether any joint of the body has a meaningful position (HasPlace).
inline bool HasPlacedJoint(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

}  // namespace ossa::recon
