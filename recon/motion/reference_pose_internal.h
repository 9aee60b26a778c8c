#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "recon/body/rig.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// Alignment of the rig with a motion whose zero angles are no pose: by joint positions in the most
/// stretched frame.
struct ReferencePose {
  SourceFrame frame;                                              // file axes
  std::array<Eigen::Quaterniond, kRigBoneCount> world_from_rest;  // the rig's bones in it, our axes
};

/// Trunk: hips and shoulders define left, the line between their midpoints up. Limbs: each bone is
/// aligned with the source's; its axial rotation is the one in which elbows and knees bend, over
/// the whole motion (a limb that never bends faces like the trunk). What positions do not
/// determine, the rotation of the head and the roll of the hands, is assumed neutral in that frame.
/// Throws InputError if hips or shoulders coincide.
ReferencePose FindReferencePose(const SourceMotion& motion, const SourceBones& bones,
                                const Eigen::Quaterniond& world_from_file);

/// Axes of a bone: its direction, a perpendicular vector as close to `front` as possible, and their
/// cross product; columns.
Eigen::Matrix3d FrameAlong(const Eigen::Vector3d& direction, const Eigen::Vector3d& front);

/// The end of a joint's segment, file axes: `next`, else its end site, else its first child, else
/// the joint itself.
Eigen::Vector3d FindEnd(const SourceMotion& motion, const SourceFrame& frame, int joint, int next);

}  // namespace ossa::recon
