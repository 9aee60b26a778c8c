#pragma once
#include <map>
#include <optional>
#include <span>

#include "recon/fuse/sighting_internal.h"

namespace ossa::recon {

/// State of a person between frames.
struct JointHistory {
  /// The last joint positions, camera 0's space: joints do not jump.
  JointArray<std::optional<Eigen::Vector3d>> position_m;
  /// By camera, the recent trust in its view of each joint, (0, 1]; 0: never seen. A camera that
  /// has lost a limb takes another one for it now and then, for a frame or two.
  std::map<size_t, JointArray<double>> trust;
};

/// Fuses several cameras' views of a body, in camera 0's space. If views of a joint are more than
/// `disagreement_m` apart, only those that agree with the likeliest count. Likelihood takes into
/// account the recent trust in the camera, how many views agree, how far the joint would jump, and
/// whether its distance from the parent joint fits that camera's own bone length. Of the remaining
/// views those with the best state (tracked before inferred before placed unseen) are averaged,
/// weighted by their inverse covariance. State, confidence and reliability are the best of these.
/// The id is not set.
BodyRecord FuseBody(std::span<const BodySighting* const> sightings, double disagreement_m,
                    JointHistory& history);

}  // namespace ossa::recon
