#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// Lower case, without "name:" prefixes and separators: "mixamorig:Left_Arm" is "leftarm".
std::string SimplifyJointName(std::string_view name);

/// Finds the joints of an arbitrary rig by common words for body parts in their names
/// ("UpperArm_L", "Bip01 L UpperArm", "DEF-upper_arm.L", "J_Bip_L_UpperArm", "mixamorig_LeftArm",
/// "lShldrBend", "humerus_l"), ignoring common prefixes and suffixes; hips, spine and neck are the
/// joints between limbs and head. None if arms or legs are not found.
std::optional<SourceBones> FindBonesByParts(const SourceMotion& motion);

}  // namespace ossa::recon
