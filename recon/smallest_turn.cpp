#include "recon/smallest_turn.h"

namespace ossa::recon {

Eigen::Quaterniond SmallestTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Eigen::Quaternionf SmallestTurn(const Eigen::Vector3f& from, const Eigen::Vector3f& to) {
  return Eigen::Quaternionf::FromTwoVectors(from, to);
}

}  // namespace ossa::recon
