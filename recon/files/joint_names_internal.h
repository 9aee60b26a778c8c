#pragma once
#include <optional>
#include <string_view>

#include "recon/skeleton.h"

namespace ossa::recon {

/// The joint that a file calls by some usual name, whatever its case, spaces, dashes and
/// underscores: SDK 1 and SDK 2 names, Azure Kinect, KinectGait ("Hip-centro"), ITOP ("RHand"),
/// joint centres of gait models ("LKJC"). Empty for a name that is none of the 20 joints.
std::optional<Joint> JointCalled(std::string_view name);

}  // namespace ossa::recon
