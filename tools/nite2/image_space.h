#pragma once
#include <NiteCTypes.h>

#include "tools/tracker/tracker.h"

/// Conversions of results of ossa::tracker to NiTE's types: pure functions.
namespace ossa::nite2 {

/// Camera space (metres, x to the sensor's left) as millimetres with x to the right of the
/// delivered image; if it is mirrored, the image's right is the sensor's left.
NitePoint3f ToNite(const Eigen::Vector3d& camera_m, bool mirrored);
/// The inverse.
Eigen::Vector3d FromNite(const NitePoint3f& point, bool mirrored);

/// A rotation of camera space, in the axes of ToNite.
NiteQuaternion TurnToNite(const Eigen::Quaterniond& rotation, bool mirrored);

/// The floor's plane, and the point of it nearest to the sensor.
NitePlane FloorToNite(const Eigen::Vector4d& floor, bool mirrored);

/// The 15 joints of a body that is fully tracked. Confidence is 1 for tracked joints, 0.5 for
/// inferred ones, 0 for others. Orientations are rotations from a T-pose that faces the sensor.
void FillJoints(const tracker::Body& body, bool mirrored, NiteSkeletonJoint* joints);

}  // namespace ossa::nite2
