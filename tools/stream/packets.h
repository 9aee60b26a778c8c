#pragma once
#include <string>

#include "tools/stream/unity_humanoid.h"

namespace ossa::stream {

/// One moment of one person for a VMC receiver, an OSC bundle: available, time (seconds since the
/// first frame: it has a float for them), root, and every
/// bone of HumanBodyBones as its parent sees it; with `seen_only` none of MakeRestBones.
std::string VmcPacket(const Humanoid& world, double time_s, bool seen_only = false);

/// One moment of one person as VRChat's trackers 1 to 8 (hip, chest, left and right foot, knee,
/// elbow) and head, an OSC bundle: metres times `scale`, Euler degrees in Unity's order.
std::string VrchatPacket(const Humanoid& world, double scale);

/// Throws InputError where ossa was built without OSC.
void CheckHasOsc();

/// Unity's Euler angles in degrees: about z, then x, then y.
Eigen::Vector3d EulerDegrees(const Eigen::Quaterniond& rotation);

}  // namespace ossa::stream
