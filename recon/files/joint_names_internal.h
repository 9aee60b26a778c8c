#pragma once
#include <optional>
#include <string_view>

#include "recon/skeleton.h"

namespace ossa::recon {

/// The joint of a common name, regardless of case, spaces, dashes and underscores: SDK 1 and SDK 2
/// names, Azure Kinect, KinectGait ("Hip-centro"), ITOP ("RHand"), joint centres of gait models
/// ("LKJC"). Empty for a name that is none of the 20 joints.
std::optional<Joint> FindJointByName(std::string_view name);

}  // namespace ossa::recon
