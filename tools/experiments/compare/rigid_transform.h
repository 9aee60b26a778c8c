#pragma once
#include <optional>
#include <vector>

#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

/// The rigid transform (no scale) that brings points `from` onto `to` with the least squared error
/// (Kabsch 1976, Umeyama 1991). Columns are points; at least one.
Eigen::Matrix4d RigidTransform(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to);

/// Joints that postures in two spaces share.
class CommonJoints {
 public:
  void Add(const SparsePosture& from, const SparsePosture& to);
  /// Maps the first onto the second; empty for fewer than three joints.
  std::optional<Eigen::Matrix4d> Align() const;

 private:
  std::vector<Eigen::Vector3d> from_m_, to_m_;
};

}  // namespace ossa::tools
