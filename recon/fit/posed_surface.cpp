#include "recon/fit/posed_surface.h"

#include <Eigen/Geometry>

namespace ossa::recon {

Eigen::Matrix3d ToRotation(const Eigen::Vector3d& turn_rad) {
  constexpr double kNone_rad = 1e-12;  // by hand: below, the axis is undefined by rounding
  const double angle_rad = turn_rad.norm();
  if (angle_rad < kNone_rad) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_rad, turn_rad / angle_rad).toRotationMatrix();
}

Eigen::Vector3d ToRotationVector(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

PosedSurface::PosedSurface(const BodySurface& surface)
    : surface_(surface),
      at_m_(surface.points.size(), Eigen::Vector3d::Zero()),
      normal_(surface.points.size(), Eigen::Vector3d::UnitZ()),
      faces_camera_(surface.points.size(), 0) {
  PoseSegments(pose_);
}

void PosedSurface::PoseSegments(const SurfacePose& pose) {
  pose_ = pose;
  camera_from_[0] = pose.parent_from_segment[0];
  joint_m_[0] = pose.pelvis_m;
  joint_by_shape_m_[0].setZero();
  for (size_t s = 1; s < kSegmentCount; ++s) {
    const size_t p = ParentSegment(s);
    const ShapedPlace& joint = surface_.joint[s];
    camera_from_[s] = camera_from_[p] * pose.parent_from_segment[s];
    joint_m_[s] = joint_m_[p] + camera_from_[p] * joint.At(pose.shape);
    joint_by_shape_m_[s] = joint_by_shape_m_[p] + camera_from_[p] * joint.by_shape_m;
  }
}

void PosedSurface::PosePoints() {
  for (size_t i = 0; i < at_m_.size(); ++i) {
    const SurfacePoint& point = surface_.points[i];
    const Eigen::Matrix3d& camera_from = camera_from_[point.segment];
    at_m_[i] = joint_m_[point.segment] + camera_from * point.place.At(pose_.shape);
    normal_[i] = camera_from * point.normal;
    faces_camera_[i] = normal_[i].dot(at_m_[i]) < 0.0;
  }
}

Eigen::Vector3d PosedSurface::LandmarkAt(size_t joint) const {
  const size_t s = surface_.landmark_segment[joint];
  return joint_m_[s] + camera_from_[s] * surface_.landmark[joint].At(pose_.shape);
}

Posture PosedSurface::Landmarks() const {
  Posture joints;
  for (size_t j = 0; j < kJointCount; ++j) joints.position_m[j] = LandmarkAt(j);
  return joints;
}

}  // namespace ossa::recon
