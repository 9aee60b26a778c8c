#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "recon/fit/body_surface.h"

namespace ossa::recon {

/// Rotation of a rotation vector (radians), and back; the angle of the latter is at most half a
/// turn.
Eigen::Matrix3d ToRotation(const Eigen::Vector3d& turn_rad);
Eigen::Vector3d ToRotationVector(const Eigen::Matrix3d& rotation);

/// Pose and shape of a body surface.
struct SurfacePose {
  std::array<Eigen::Matrix3d, kSegmentCount> parent_from_segment;  // pelvis: camera from pelvis
  Eigen::Vector3d pelvis_m = Eigen::Vector3d::Zero();              // its joint, camera space
  ShapeVector shape = ShapeVector::Zero();

  SurfacePose() { parent_from_segment.fill(Eigen::Matrix3d::Identity()); }
};

/// A body surface in a pose, by forward kinematics. Camera space, metres. Allocates only when it is
/// constructed.
class PosedSurface {
 public:
  /// The surface must outlive this object.
  explicit PosedSurface(const BodySurface& surface);

  /// Poses the segments: joints and landmarks are valid afterwards, points are not.
  void PoseSegments(const SurfacePose& pose);
  /// Poses the points, after PoseSegments, and finds those that face the camera.
  void PosePoints();

  const BodySurface& surface() const { return surface_; }
  const SurfacePose& pose() const { return pose_; }
  const Eigen::Matrix3d& camera_from(size_t segment) const { return camera_from_[segment]; }
  const Eigen::Vector3d& joint_m(size_t segment) const { return joint_m_[segment]; }
  /// Derivative of the segment's joint with respect to shape: d joint_m / d shape.
  const ShapeBasis& joint_by_shape_m(size_t segment) const { return joint_by_shape_m_[segment]; }
  Eigen::Vector3d LandmarkAt(size_t joint) const;
  Posture Landmarks() const;

  const std::vector<Eigen::Vector3d>& at_m() const { return at_m_; }
  const std::vector<Eigen::Vector3d>& normal() const { return normal_; }
  bool FacesCamera(size_t point) const { return faces_camera_[point] != 0; }

 private:
  const BodySurface& surface_;
  SurfacePose pose_;
  std::array<Eigen::Matrix3d, kSegmentCount> camera_from_;
  std::array<Eigen::Vector3d, kSegmentCount> joint_m_;
  std::array<ShapeBasis, kSegmentCount> joint_by_shape_m_;
  std::vector<Eigen::Vector3d> at_m_, normal_;
  std::vector<uint8_t> faces_camera_;
};

}  // namespace ossa::recon
