#include <Eigen/SVD>
#include <algorithm>

#include "recon/fuse/rigid_alignment_internal.h"

namespace ossa::recon {

void RigidAlignment::Add(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m,
                         double weight) {
  weight_ += weight;
  from_sum_ += weight * from_m;
  to_sum_ += weight * to_m;
  product_sum_ += weight * to_m * from_m.transpose();
  square_sum_ += weight * (from_m.squaredNorm() + to_m.squaredNorm());
}

void RigidAlignment::AddDirection(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  double weight) {
  directions_ += weight * to * from.transpose();
}

RigidAlignment::Result RigidAlignment::Solve() const {
  Result result;
  if (!(weight_ > 0.0)) return result;
  const Eigen::Vector3d from_mean = from_sum_ / weight_, to_mean = to_sum_ / weight_;
  const Eigen::Matrix3d spread = product_sum_ - weight_ * to_mean * from_mean.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread + directions_,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d signs = Eigen::Vector3d::Ones();  // S of eq. 43: excludes reflections
  if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) signs.z() = -1.0;
  const Eigen::Matrix3d turn = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  result.to_from_from.linear() = turn;
  result.to_from_from.translation() = to_mean - turn * from_mean;
  const double squares = square_sum_ - weight_ * (from_mean.squaredNorm() + to_mean.squaredNorm());
  const double explained = 2.0 * (turn.transpose() * spread).trace();
  result.mean_square_m2 = std::max(0.0, (squares - explained) / weight_);
  return result;
}

}  // namespace ossa::recon
