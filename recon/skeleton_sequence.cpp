#include "recon/skeleton_sequence.h"

#include <algorithm>

namespace ossa::recon {
namespace {

double ConfidenceOf(TrackingState state) {
  if (state == TrackingState::kTracked) return 1.0;
  return state == TrackingState::kInferred ? 0.5 : 0.0;
}

}  // namespace

bool HasPlace(const JointRecord& joint) {
  const bool somewhere = joint.state != TrackingState::kNotTracked || joint.reliability.has_value();
  return somewhere && joint.position_m.allFinite();
}

std::optional<int> RepeatedBody(const SkeletonFrame& frame) {
  for (auto body = frame.bodies.begin(); body != frame.bodies.end(); ++body) {
    const bool repeats = std::any_of(frame.bodies.begin(), body,
                                     [&](const BodyRecord& other) { return other.id == body->id; });
    if (repeats) return body->id;
  }
  return std::nullopt;
}

TrackedPosture ToTrackedPosture(const BodyRecord& body) {
  TrackedPosture tracked;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto& joint = body.joints[j];
    if (!joint) continue;
    tracked.posture.position_m[j] = joint->position_m;
    tracked.state[j] = joint->state.value_or(TrackingState::kTracked);
    tracked.confidence[j] = joint->confidence.value_or(ConfidenceOf(tracked.state[j]));
  }
  return tracked;
}

}  // namespace ossa::recon
