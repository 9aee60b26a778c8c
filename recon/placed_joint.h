#pragma once
#include <algorithm>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Whether any joint of the body has a meaningful position (HasPlace).
inline bool HasPlacedJoint(const BodyRecord& body) {
  return std::any_of(body.joints.begin(), body.joints.end(),
                     [](const auto& joint) { return joint && HasPlace(*joint); });
}

}  // namespace ossa::recon
