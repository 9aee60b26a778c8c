#pragma once
#include <Eigen/Geometry>

namespace ossa::recon {

/// The rotation and translation, without scale, that bring points onto others by least weighted
/// squares (Kabsch 1976; Umeyama 1991, eqs. 34-43 with c = 1). Sums alone are kept: pairs are added
/// one at a time. All in metres.
class RigidAlignment {
 public:
  /// One pair of points, weight > 0, no unit.
  void Add(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double weight);
  /// One pair of directions, unit vectors, that shall fall together: weighs as two pairs of points
  /// a metre away on either side of the points' mean, of half the weight each.
  void AddDirection(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double weight);

  /// Sum of the weights of points.
  double weight() const { return weight_; }
  struct Result {
    Eigen::Isometry3d to_from_from = Eigen::Isometry3d::Identity();
    double mean_square_m2 = 0.0;  // of what is left of the points, by weight
  };
  /// At least three points that are on no line; else some rotation of those that fit.
  Result Solve() const;

 private:
  double weight_ = 0.0;
  Eigen::Vector3d from_sum_ = Eigen::Vector3d::Zero(), to_sum_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d product_sum_ = Eigen::Matrix3d::Zero();  // to * from^T
  Eigen::Matrix3d directions_ = Eigen::Matrix3d::Zero();   // to * from^T
  double square_sum_ = 0.0;
};

}  // namespace ossa::recon
