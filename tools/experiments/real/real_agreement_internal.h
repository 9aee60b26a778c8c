#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tools/experiments/real/real_evaluation_internal.h"

namespace ossa::tools {

/// Final joints and the peer's against the truth and against each other, each without its own
/// constant offset. Two methods that were trained on different data seldom make the same error:
/// where both are far from the truth but near each other, the truth is in doubt.
struct PeerAgreement {
  int64_t joints = 0;  // that final, peer and truth all have
  int64_t both = 0, only_final = 0, only_peer = 0, neither = 0;  // within 10 cm of the truth
  int64_t agreeing = 0;            // of neither: final and peer within 10 cm of each other
  std::vector<double> to_truth_m;  // of neither: final to truth
  std::vector<double> to_peer_m;   // of neither: final to peer
};

/// The agreement at joint `j` of the set, over all stills.
PeerAgreement CompareWithPeer(const RealSet& set, const std::vector<StillResult>& results,
                              size_t j);

PeerAgreement& operator+=(PeerAgreement& sum, const PeerAgreement& more);

/// By name: each joint of the set, in its order, then "all"; empty for a set without a peer.
std::vector<std::pair<std::string, PeerAgreement>> CompareJointsWithPeer(
    const RealSet& set, const std::vector<StillResult>& results);

}  // namespace ossa::tools
