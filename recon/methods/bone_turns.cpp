#include "recon/methods/bone_turns_internal.h"

#include "recon/database/nearest.h"
#include "recon/orientation.h"

namespace ossa::recon {

JointOrientations TurnedOntoBones(const PostureDatabase& database, std::span<const int> postures,
                                  std::span<const double> weights, const Posture& in_camera,
                                  double yaw_rad) {
  JointArray<Eigen::Vector4d> sum;
  sum.fill(Eigen::Vector4d::Zero());
  for (size_t k = 0; k < postures.size(); ++k) {
    const JointOrientations turns = database.orientations(postures[k]);
    for (size_t i = 0; i < kJointCount; ++i) {
      // q and -q are the same rotation: add the one on the side of the sum so far.
      const Eigen::Vector4d q = turns[i].coeffs();
      sum[i] += (q.dot(sum[i]) < 0.0 ? -weights[k] : weights[k]) * q;
    }
  }
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitY()));
  JointOrientations out;
  for (size_t i = 0; i < kJointCount; ++i) {
    Eigen::Quaterniond mean = Eigen::Quaterniond::Identity();
    if (sum[i].norm() > 1e-9) mean.coeffs() = sum[i].normalized();
    out[i] = turn * mean;
  }
  return AlignToBones(out, in_camera);
}

std::vector<double> InverseDistances(const PostureDatabase& database,
                                     std::span<const int> neighbours, const PostureVector& made,
                                     const JointWeights& reliability) {
  constexpr double kLeast_m2 = 1e-4;  // by hand
  std::vector<double> weights;
  for (const int n : neighbours) {
    const double d = WeightedDistance(database.postures().col(n), made, reliability);
    weights.push_back(1.0 / (kLeast_m2 + d));
  }
  return weights;
}

}  // namespace ossa::recon
