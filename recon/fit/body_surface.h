#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "recon/posture.h"

namespace ossa::recon {

/// File name of the shipped body surface.
inline constexpr const char* kShippedSurface = "body.ossasurface";

/// Rigid pieces of the body in the surface fit, parents before children.
enum class Segment : uint8_t {
  kPelvis,
  kAbdomen,
  kChest,
  kHead,
  kLeftCollar,
  kLeftUpperArm,
  kLeftForearm,
  kLeftHand,
  kRightCollar,
  kRightUpperArm,
  kRightForearm,
  kRightHand,
  kLeftThigh,
  kLeftShank,
  kLeftFoot,
  kRightThigh,
  kRightShank,
  kRightFoot
};
inline constexpr size_t kSegmentCount = 18;  // by definition
/// Each segment's parent, -1 for the pelvis.
inline constexpr std::array<int, kSegmentCount> kSegmentParent = {-1, 0, 1,  2, 2,  4,  5, 6,  2,
                                                                  8,  9, 10, 0, 12, 13, 0, 15, 16};
/// The segment's parent; the pelvis counts as its own.
constexpr size_t ParentSegment(size_t segment) {
  return segment == 0 ? 0 : static_cast<size_t>(kSegmentParent[segment]);
}

/// Number of shape components, of the body and its clothes. By hand: 95 % of the variance of
/// dressed bodies.
inline constexpr int kShapeCount = 10;
/// Standard deviations from the mean body along each component.
using ShapeVector = Eigen::Matrix<double, kShapeCount, 1>;
using ShapeMatrix = Eigen::Matrix<double, kShapeCount, kShapeCount>;
using ShapeBasis = Eigen::Matrix<double, 3, kShapeCount>;

/// A point that is linear in the shape, metres.
struct ShapedPlace {
  Eigen::Vector3d mean_m = Eigen::Vector3d::Zero();
  ShapeBasis by_shape_m = ShapeBasis::Zero();
  Eigen::Vector3d At(const ShapeVector& shape) const { return mean_m + by_shape_m * shape; }
};

/// A point on the skin or on the clothes over it.
struct SurfacePoint {
  uint8_t segment = 0;  // to which it is rigidly attached
  uint8_t part = 0;     // its label, 1..31
  ShapedPlace place;    // relative to the segment's joint, axes of the rest pose
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, outwards, axes of the rest pose
};

/// The body model of the surface fit: points with normals on rigid segments, linear in shape. Rest
/// pose and axes are the rig's: facing +z, left = +x, y up. Learned from dressed bodies and motion
/// (`ossa surface`).
struct BodySurface {
  std::array<ShapedPlace, kSegmentCount> joint;  // relative to the parent's joint; pelvis: zero
  /// Prior of each segment's rotation relative to its parent, as a rotation vector (radians): mean
  /// and inverse covariance over natural motion.
  std::array<Eigen::Vector3d, kSegmentCount> turn_mean;
  std::array<Eigen::Matrix3d, kSegmentCount> turn_information;
  JointArray<uint8_t> landmark_segment{};
  JointArray<ShapedPlace> landmark;  // the SDK's joints, relative to their segment's joint
  double stature_mean_m = 0.0;
  ShapeVector stature_by_shape_m = ShapeVector::Zero();
  std::vector<SurfacePoint> points;  // by part, ascending

  double Stature_m(const ShapeVector& shape) const {
    return stature_mean_m + stature_by_shape_m.dot(shape);
  }

  /// Reads a .ossasurface. Throws InputError with file and byte for damaged and hostile files.
  static constexpr uint32_t kVersion = 1;
  static constexpr size_t kMostPoints = 4096;  // by hand: more would gain nothing
  static BodySurface Load(const std::filesystem::path& path);
  static BodySurface FromBytes(std::span<const std::byte> bytes, const std::string& name);
  void Save(const std::filesystem::path& path) const;
  /// Whether the file has the format's magic number; it may still be damaged.
  static bool IsFile(const std::filesystem::path& path);
};

}  // namespace ossa::recon
