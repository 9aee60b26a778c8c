#include "recon/fit/pose_from_joints.h"

#include <Eigen/Geometry>

namespace ossa::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Rotations = std::array<Matrix3d, kSegmentCount>;

constexpr size_t Number(Segment segment) { return static_cast<size_t>(segment); }

// Rotation with x to the left and y up; arbitrary if both are parallel.
Matrix3d TrunkRotation(const Vector3d& left, const Vector3d& up) {
  const Vector3d y = up.norm() > 0.0 ? Vector3d(up.normalized()) : Vector3d::UnitY();
  Vector3d x = left - y * y.dot(left);
  x = x.norm() > 0.0 ? Vector3d(x.normalized()) : y.unitOrthogonal();
  Matrix3d rotation;
  rotation << x, y, x.cross(y);
  return rotation;
}

// Aims segments one after another.
struct Aimer {
  const BodySurface& surface;
  const Posture& joints_m;
  Rotations camera_from;

  // Rotates from the parent's rotation and the mean joint rotation so that `rest` points along
  // `seen`.
  void Aim(size_t segment, const Vector3d& rest, const Vector3d& seen) {
    const Matrix3d carried =
        camera_from[ParentSegment(segment)] * ToRotation(surface.turn_mean[segment]);
    camera_from[segment] =
        Eigen::Quaterniond::FromTwoVectors(carried * rest, seen).toRotationMatrix() * carried;
  }
  // Aims three segments from `first` on; their joints are those from `joint` on, and the last one
  // ends in the joint after these.
  void AimLimb(size_t first, size_t joint) {
    for (size_t k = 0; k < 3; ++k) {
      const Vector3d& rest =
          k < 2 ? surface.joint[first + k + 1].mean_m : surface.landmark[joint + 3].mean_m;
      Aim(first + k, rest, joints_m.position_m[joint + k + 1] - joints_m.position_m[joint + k]);
    }
  }
};

}  // namespace

SurfacePose PoseFromJoints(const BodySurface& surface, const Posture& at) {
  Aimer aimer{surface, at, {}};
  const Vector3d hips_m = 0.5 * (at[Joint::kHipLeft] + at[Joint::kHipRight]);
  const Matrix3d pelvis =
      TrunkRotation(at[Joint::kHipLeft] - at[Joint::kHipRight], at[Joint::kSpine] - hips_m);
  const Matrix3d chest = TrunkRotation(at[Joint::kShoulderLeft] - at[Joint::kShoulderRight],
                                       at[Joint::kShoulderCenter] - at[Joint::kSpine]);
  aimer.camera_from.fill(chest);
  aimer.camera_from[Number(Segment::kPelvis)] = pelvis;
  aimer.camera_from[Number(Segment::kAbdomen)] =
      Eigen::Quaterniond(pelvis).slerp(0.5, Eigen::Quaterniond(chest)).toRotationMatrix();
  aimer.Aim(Number(Segment::kHead), surface.landmark[Joint::kHead].mean_m,
            at[Joint::kHead] - at[Joint::kShoulderCenter]);
  aimer.AimLimb(Number(Segment::kLeftUpperArm), Index(Joint::kShoulderLeft));
  aimer.AimLimb(Number(Segment::kRightUpperArm), Index(Joint::kShoulderRight));
  aimer.AimLimb(Number(Segment::kLeftThigh), Index(Joint::kHipLeft));
  aimer.AimLimb(Number(Segment::kRightThigh), Index(Joint::kHipRight));
  SurfacePose pose;
  pose.pelvis_m = hips_m;
  pose.parent_from_segment[0] = pelvis;
  for (size_t s = 1; s < kSegmentCount; ++s) {
    pose.parent_from_segment[s] =
        aimer.camera_from[ParentSegment(s)].transpose() * aimer.camera_from[s];
  }
  return pose;
}

}  // namespace ossa::recon
