#pragma once
#include "recon/posture.h"

namespace ossa::recon {

/// Orientations of the bones from joint positions alone, in the convention of the Kinect for
/// Windows SDK 1.5-1.8 ("Joint Orientation"): entry i belongs to the bone that ends in joint i and
/// rotates bone coordinates to the frame of the positions; the bone's y axis runs along the bone
/// from parent to joint i. Entry 0 (HipCenter) is the player: x to the player's left, y up along
/// the body, z out of the player's front.
///
/// The rotation about the bone's own axis, which positions do not determine, follows from a rest
/// pose: a T-pose that faces +z with its left at +x. There every bone's z axis points forward (+z),
/// except the feet's, which point up (+y), and x = y cross z. In other poses - the pelvis and the
/// shoulders turn the trunk bones (x from right to left hip or shoulder), - a bent elbow or knee
/// turns the upper limb: x is the hinge's axis, so that a positive rotation about x flexes an elbow
/// and a negative one a knee, - every other bone follows its parent by the smallest rotation; a
/// nearly straight limb does so too, blended over 10-30 degrees of flexion so that nothing jumps.
///
/// Bones of zero length or with non-finite ends keep their parent's turn.
JointOrientations ComputeOrientations(const Posture& posture);

/// Aligns known orientations (of a rig, a database, a physical character) with a posture: each is
/// rotated by the smallest rotation onto its bone, which keeps the twist. Bones without direction
/// stay unchanged. Entry 0 follows from hips and spine.
JointOrientations AlignToBones(const JointOrientations& orientations, const Posture& posture);

/// The orientation of each bone at rest, as described above.
const JointOrientations& RestOrientations();

/// The SDK's second form: each bone relative to its parent bone; HipCenter stays absolute.
JointOrientations ToHierarchical(const JointOrientations& absolute);
/// Inverse of ToHierarchical.
JointOrientations ToAbsolute(const JointOrientations& hierarchical);

/// An absolute orientation of the Kinect SDK 2 (Body.JointOrientations) in the convention above.
/// They differ by a quarter turn about the bones that end in elbows, knees and ankles. The SDK 2
/// rotates wrists and hands about the forearm by thumb and fingers: they stay as they are.
Eigen::Quaterniond OrientationFromSdk2(Joint joint, const Eigen::Quaterniond& sdk2);
/// Inverse of OrientationFromSdk2.
Eigen::Quaterniond OrientationToSdk2(Joint joint, const Eigen::Quaterniond& orientation);

}  // namespace ossa::recon
