#include "tools/nite2/image_space.h"

#include <array>

#include "recon/orientation.h"

namespace ossa::nite2 {
namespace {

using recon::Joint;
using recon::TrackingState;

constexpr double kMillimetres = 1000.0;  // in a metre; by definition

// A NiTE joint's position and the bone with its orientation: the bone that starts at the joint, or
// at ends of limbs the one that ends there.
struct JointSource {
  NiteJointType type;
  Joint place;
  Joint bone;
};
constexpr std::array<JointSource, NITE_JOINT_COUNT> kSources = {
    {{NITE_JOINT_HEAD, Joint::kHead, Joint::kHead},
     {NITE_JOINT_NECK, Joint::kShoulderCenter, Joint::kHead},
     {NITE_JOINT_LEFT_SHOULDER, Joint::kShoulderLeft, Joint::kElbowLeft},
     {NITE_JOINT_RIGHT_SHOULDER, Joint::kShoulderRight, Joint::kElbowRight},
     {NITE_JOINT_LEFT_ELBOW, Joint::kElbowLeft, Joint::kWristLeft},
     {NITE_JOINT_RIGHT_ELBOW, Joint::kElbowRight, Joint::kWristRight},
     {NITE_JOINT_LEFT_HAND, Joint::kHandLeft, Joint::kHandLeft},
     {NITE_JOINT_RIGHT_HAND, Joint::kHandRight, Joint::kHandRight},
     {NITE_JOINT_TORSO, Joint::kSpine, Joint::kShoulderCenter},
     {NITE_JOINT_LEFT_HIP, Joint::kHipLeft, Joint::kKneeLeft},
     {NITE_JOINT_RIGHT_HIP, Joint::kHipRight, Joint::kKneeRight},
     {NITE_JOINT_LEFT_KNEE, Joint::kKneeLeft, Joint::kAnkleLeft},
     {NITE_JOINT_RIGHT_KNEE, Joint::kKneeRight, Joint::kAnkleRight},
     {NITE_JOINT_LEFT_FOOT, Joint::kAnkleLeft, Joint::kAnkleLeft},
     {NITE_JOINT_RIGHT_FOOT, Joint::kAnkleRight, Joint::kAnkleRight}}};

float ConfidenceOf(TrackingState state) {
  if (state == TrackingState::kTracked) return 1.0F;
  return state == TrackingState::kInferred ? 0.5F : 0.0F;
}

// Camera from bone in a T-pose that faces the sensor, which looks along +z as the rest pose does.
Eigen::Quaterniond FacingRest(Joint bone) {
  static const Eigen::Quaterniond half_turn(0.0, 0.0, 1.0, 0.0);
  return half_turn * recon::RestOrientations()[bone];
}

// The middle of the trunk.
Eigen::Vector3d TorsoOf(const tracker::Body& body) {
  const auto at = [&](Joint joint) { return body.joints[joint].position_m; };
  return 0.5 * at(Joint::kShoulderCenter) + 0.25 * (at(Joint::kHipLeft) + at(Joint::kHipRight));
}

}  // namespace

NitePoint3f ToNite(const Eigen::Vector3d& camera_m, bool mirrored) {
  const Eigen::Vector3f p = (camera_m * kMillimetres).cast<float>();
  return {mirrored ? p.x() : -p.x(), p.y(), p.z()};
}

Eigen::Vector3d FromNite(const NitePoint3f& point, bool mirrored) {
  const Eigen::Vector3f p(mirrored ? point.x : -point.x, point.y, point.z);
  return p.cast<double>() / kMillimetres;
}

NiteQuaternion TurnToNite(const Eigen::Quaterniond& rotation, bool mirrored) {
  const Eigen::Quaternionf q = rotation.normalized().cast<float>();
  if (mirrored) return {q.x(), q.y(), q.z(), q.w()};
  return {q.x(), -q.y(), -q.z(), q.w()};  // mirroring at x = 0 negates the rotation about y and z
}

NitePlane FloorToNite(const Eigen::Vector4d& floor, bool mirrored) {
  const Eigen::Vector3d normal = floor.head<3>();
  NitePlane plane;
  plane.point = ToNite(-floor.w() * normal, mirrored);
  plane.normal = ToNite(normal / kMillimetres, mirrored);
  return plane;
}

void FillJoints(const tracker::Body& body, bool mirrored, NiteSkeletonJoint* joints) {
  for (const JointSource& source : kSources) {
    const tracker::JointEstimate& place = body.joints[source.place];
    const tracker::JointEstimate& bone = body.joints[source.bone];
    NiteSkeletonJoint& joint = joints[source.type];
    joint.jointType = source.type;
    joint.position =
        ToNite(source.type == NITE_JOINT_TORSO ? TorsoOf(body) : place.position_m, mirrored);
    joint.positionConfidence = ConfidenceOf(place.state);
    joint.orientation =
        TurnToNite(bone.orientation * FacingRest(source.bone).conjugate(), mirrored);
    joint.orientationConfidence = ConfidenceOf(bone.state);
  }
}

}  // namespace ossa::nite2
