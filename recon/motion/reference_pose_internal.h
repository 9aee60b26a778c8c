#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "recon/body/rig.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// How the rig lies on a motion whose zero angles are no pose: by the places of its joints in the
/// frame where the body is stretched most.
struct ReferencePose {
  SourceFrame frame;                                              // file axes
  std::array<Eigen::Quaterniond, kRigBoneCount> world_from_rest;  // the rig's bones then, our axes
};

/// Trunk: hips and shoulders give left, the line between their middles up. Limbs: each bone lies
/// along the source's, its turn about itself is that in which elbows and knees bend, seen over the
/// whole motion (a limb that never bends faces as the trunk does). What places cannot tell, the
/// turn of the head and the roll of the hands, is taken as neutral in that frame. Throws InputError
/// where hips or shoulders coincide.
ReferencePose FindReferencePose(const SourceMotion& motion, const SourceBones& bones,
                                const Eigen::Quaterniond& world_from_file);

/// Axes of a bone: its direction, a vector square to it as near to `front` as can be, and what is
/// square to both; columns.
Eigen::Matrix3d FrameAlong(const Eigen::Vector3d& direction, const Eigen::Vector3d& front);

/// Where what a joint turns ends, file axes: at `next`, or at its end site, or its first child, or
/// (of a joint that has none of them) at itself.
Eigen::Vector3d FindEnd(const SourceMotion& motion, const SourceFrame& frame, int joint, int next);

}  // namespace ossa::recon
