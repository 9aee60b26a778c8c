#include "tools/experiments/compare/rigid_transform.h"

#include <Eigen/SVD>

namespace ossa::tools {

Eigen::Matrix4d RigidTransform(const Eigen::Matrix3Xd& from, const Eigen::Matrix3Xd& to) {
  const Eigen::Vector3d from_mean = from.rowwise().mean();
  const Eigen::Vector3d to_mean = to.rowwise().mean();
  const Eigen::Matrix3d covariance =
      (to.colwise() - to_mean) * (from.colwise() - from_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();
  // For some data a reflection fits better than any rotation, but bodies are never mirrored.
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) signs.z() = -1;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  Eigen::Matrix4d transform = Eigen::Matrix4d::Identity();
  transform.topLeftCorner<3, 3>() = rotation;
  transform.topRightCorner<3, 1>() = to_mean - rotation * from_mean;
  return transform;
}

void CommonJoints::Add(const SparsePosture& from, const SparsePosture& to) {
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (!from.present[j] || !to.present[j]) continue;
    from_m_.push_back(from.position_m[j]);
    to_m_.push_back(to.position_m[j]);
  }
}

std::optional<Eigen::Matrix4d> CommonJoints::Align() const {
  constexpr size_t kFewest = 3;  // points; by definition, fewer leave a rotation undetermined
  if (from_m_.size() < kFewest) return std::nullopt;
  const auto points = static_cast<Eigen::Index>(from_m_.size());
  return RigidTransform(Eigen::Map<const Eigen::Matrix3Xd>(from_m_[0].data(), 3, points),
                        Eigen::Map<const Eigen::Matrix3Xd>(to_m_[0].data(), 3, points));
}

}  // namespace ossa::tools
