#pragma once
#include <map>
#include <optional>
#include <span>

#include "recon/fuse/sighting_internal.h"

namespace ossa::recon {

/// What is remembered of a person from moment to moment.
struct JointHistory {
  /// Where the joints were the last time, camera 0's space: joints do not jump.
  JointArray<std::optional<Eigen::Vector3d>> position_m;
  /// By camera, how far its view of each joint could be believed of late, (0, 1]; 0: never seen. A
  /// camera that has lost a limb finds another in its place now and then, for a frame or two.
  std::map<size_t, JointArray<double>> trust;
};

/// One body of what several cameras see of it, in camera 0's space. Where cameras have a joint more
/// than `disagreement_m` apart, those count that agree with the likeliest: by what was to be
/// believed of its camera of late, by how many agree, by how far it jumps, and by how its distance
/// from the parent joint fits that camera's own bone. Of those that count the ones whose state is
/// best (tracked before inferred before placed unseen) are averaged, each weighed by the inverse of
/// its covariance. State, confidence and reliability are the best of these. The id is not set.
BodyRecord FuseBody(std::span<const BodySighting* const> sightings, double disagreement_m,
                    JointHistory& history);

}  // namespace ossa::recon
