#pragma once
#include <Eigen/Geometry>

namespace ossa::recon {

/// Weighted least-squares rotation and translation, without scale, between corresponding points
/// (Kabsch 1976; Umeyama 1991, eqs. 34-43 with c = 1). Only sums are stored, so pairs are added one
/// at a time. Metres.
class RigidAlignment {
 public:
  /// Adds a pair of points; weight > 0, no unit.
  void Add(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double weight);
  /// Adds a pair of directions (unit vectors) to be aligned: equivalent to two pairs of points one
  /// metre on either side of the mean, each with half the weight.
  void AddDirection(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight);

  /// Sum of the point weights.
  double weight() const { return weight_; }
  struct Result {
    Eigen::Isometry3d to_from_from = Eigen::Isometry3d::Identity();
    double mean_square_m2 = 0.0;  // weighted mean squared residual of the points
  };
  /// Needs at least three non-collinear points; else one of the optimal rotations.
  Result Solve() const;

 private:
  double weight_ = 0.0;
  Eigen::Vector3d from_sum_ = Eigen::Vector3d::Zero(), to_sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d product_sum_ = Eigen::Matrix3d::Zero();  // to * from^T
  Eigen::Matrix3d directions_ = Eigen::Matrix3d::Zero();   // to * from^T
  double square_sum_ = 0.0;
};

}  // namespace ossa::recon
