#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// Lower case, without "name:" prefixes and separators: "mixamorig:Left_Arm" is "leftarm".
std::string SimplifyJointName(std::string_view name);

/// The joints of a rig of whatever studio, by the parts of the body that its names say in some
/// usual word ("UpperArm_L", "Bip01 L UpperArm", "DEF-upper_arm.L", "J_Bip_L_UpperArm",
/// "mixamorig_LeftArm", "lShldrBend", "humerus_l"), whatever all names begin or end with; hips,
/// spine and neck are what lies between the limbs and the head. None when arms or legs are not
/// found.
std::optional<SourceBones> FindBonesByParts(const SourceMotion& motion);

}  // namespace ossa::recon
