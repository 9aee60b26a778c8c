// Final joints and a peer's, against the truth and against each other.
#include "tools/experiments/real/real_agreement_internal.h"

namespace ossa::tools {
namespace {

void Count(const Eigen::Vector3d& final_error_m, const Eigen::Vector3d& peer_error_m,
           PeerAgreement& sum) {
  const bool final_near = final_error_m.norm() <= kNearTruth_m;
  const bool peer_near = peer_error_m.norm() <= kNearTruth_m;
  ++sum.joints;
  sum.both += final_near && peer_near ? 1 : 0;
  sum.only_final += final_near && !peer_near ? 1 : 0;
  sum.only_peer += peer_near && !final_near ? 1 : 0;
  if (final_near || peer_near) return;
  const double to_peer_m = (final_error_m - peer_error_m).norm();
  ++sum.neither;
  sum.agreeing += to_peer_m <= kNearTruth_m ? 1 : 0;
  sum.to_truth_m.push_back(final_error_m.norm());
  sum.to_peer_m.push_back(to_peer_m);
}

}  // namespace

PeerAgreement CompareWithPeer(const RealSet& set, const std::vector<StillResult>& results,
                              size_t j) {
  PeerAgreement sum;
  for (size_t i = 0; i < results.size(); ++i) {
    const auto final_m = ErrorWithoutOffset(set, results, RealStage::kFinal, i, j);
    const auto peer_m = ErrorWithoutOffset(set, results, RealStage::kPeer, i, j);
    if (final_m && peer_m) Count(*final_m, *peer_m, sum);
  }
  return sum;
}

PeerAgreement& operator+=(PeerAgreement& sum, const PeerAgreement& more) {
  sum.joints += more.joints;
  sum.both += more.both;
  sum.only_final += more.only_final;
  sum.only_peer += more.only_peer;
  sum.neither += more.neither;
  sum.agreeing += more.agreeing;
  sum.to_truth_m.insert(sum.to_truth_m.end(), more.to_truth_m.begin(), more.to_truth_m.end());
  sum.to_peer_m.insert(sum.to_peer_m.end(), more.to_peer_m.begin(), more.to_peer_m.end());
  return sum;
}

std::vector<std::pair<std::string, PeerAgreement>> CompareJointsWithPeer(
    const RealSet& set, const std::vector<StillResult>& results) {
  std::vector<std::pair<std::string, PeerAgreement>> joints;
  if (set.peer.empty()) return joints;
  PeerAgreement all;
  for (size_t j = 0; j < set.joints.size(); ++j) {
    joints.emplace_back(set.joint_names[j], CompareWithPeer(set, results, j));
    all += joints.back().second;
  }
  joints.emplace_back("all", std::move(all));
  return joints;
}

}  // namespace ossa::tools
