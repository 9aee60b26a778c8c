#pragma once
#include "recon/body/rig.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// Brings a performer's motion to the rig: each rig bone turns as the source's bone turns in the
/// world, after a fixed rotation that lays the rig's rest pose (A-pose) onto the source's (T-pose
/// or any other). Bone lengths are the rig's; the root's path is scaled by the ratio of leg lengths
/// and set so that the lowest foot stands on the floor. The clip has a frame every `frame_s`.
MotionClip Retarget(const SourceMotion& motion, const SourceBones& bones, double frame_s);

/// Lifts and pulls each clavicle with its upper arm. Shoulder blades turn about 1° for every 2° of
/// the arm's elevation, some of it as lift of the clavicle (Inman 1944); mocap conversions leave
/// the collar still, and a lifted arm would tear the shoulder's skin. Turns already in the
/// clavicles count. Needs the rotations of Spine1 and the arms.
void FollowArmsWithCollars(RigPose& pose);

/// Moves the whole clip vertically so that its lowest feet stand on the floor (5th percentile, so
/// that a jump or a stumble does not decide), unless it is further than `limit_m` from it: then the
/// performer stands on something.
void SetOnFloor(MotionClip& clip, double limit_m = 0.15);

}  // namespace ossa::recon
