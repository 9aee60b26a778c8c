#pragma once
#include <Eigen/Geometry>
#include <optional>

#include "recon/skeleton_sequence.h"

namespace ossa::recon {

inline constexpr size_t kV2Joints = 25;  // of the Kinect SDK 2

/// Our joint for a joint index of SDK 2; none for Neck, hand tips and thumbs.
std::optional<Joint> JointOfV2(size_t joint);

/// Stores SDK 2's orientation of a joint that has a position, unless it is no rotation: end joints
/// have none, nor do seated recordings.
void PutSdk2Orientation(BodyRecord& body, Joint joint, const Eigen::Quaterniond& sdk2);

}  // namespace ossa::recon
