#pragma once
#include "recon/body/rig.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// Retargets a performer's motion to the rig: each rig bone rotates like the source's bone in the
/// world, after a constant rotation that aligns the rig's rest pose (A-pose) with the source's
/// (T-pose or any other). Bone lengths are the rig's; the root path is scaled by the ratio of leg
/// lengths and moved so that the lowest foot is on the floor. The clip has a frame every `frame_s`.
MotionClip Retarget(const SourceMotion& motion, const SourceBones& bones, double frame_s);

/// Rotates each clavicle with its upper arm. Shoulder blades rotate about 1° for every 2° of arm
/// elevation, partly as elevation of the clavicle (Inman 1944); mocap conversions keep the collar
/// fixed, and a lifted arm would tear the shoulder's skin. Existing clavicle rotations are taken
/// into account. Needs the rotations of Spine1 and the arms.
void FollowArmsWithCollars(RigPose& pose);

/// Moves the whole clip vertically so that its lowest feet are on the floor (5th percentile, robust
/// to jumps and stumbles), unless it is farther than `limit_m` from it: then the performer stands
/// on something.
void SetOnFloor(MotionClip& clip, double limit_m = 0.15);

}  // namespace ossa::recon
