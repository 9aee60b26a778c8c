#include "recon/models/error_gains_internal.h"

#include <algorithm>

namespace ossa::recon {

// Constants: by hand.

std::vector<PosturePair> WithoutGrossErrors(const std::vector<PosturePair>& pairs, double gross_m) {
  std::vector<PosturePair> usable;
  for (const PosturePair& pair : pairs) {
    if (pair.worst_m < gross_m) usable.push_back(pair);
  }
  return usable.size() >= 10 ? usable : pairs;
}

JointWeights ComputeGains(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                          const std::vector<Posture>& offsets) {
  JointWeights agree{}, square{}, gains{};
  for (size_t i = 0; i < pairs.size(); ++i) {
    for (size_t j = 0; j < kJointCount; ++j) {
      if (pairs[i].known[j] == 0.0 || fold[i] == kNoFold) continue;
      const Eigen::Vector3d& offset = offsets[i].position_m[j];
      agree[j] += offset.dot(pairs[i].residual.position_m[j]);
      square[j] += offset.squaredNorm();
    }
  }
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto m = kMirroredJoint[j];
    const double total = square[j] + square[m];
    const double held = total > 0.0 ? (agree[j] + agree[m]) / total : 0.0;
    // No unit. A gain below a half means that errors differ between people more than they have in
    // common.
    constexpr double kLeastGain = 0.5;
    gains[j] = held < kLeastGain ? 0.0 : std::min(held, 1.0);
  }
  return gains;
}

double ErrorLeft(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                 const std::vector<Posture>& offsets, const JointWeights& gains) {
  double sum_m = 0.0, count = 0.0;
  for (size_t i = 0; i < pairs.size(); ++i) {
    for (size_t j = 0; j < kJointCount; ++j) {
      if (pairs[i].known[j] == 0.0 || fold[i] == kNoFold) continue;
      sum_m += (pairs[i].residual.position_m[j] - gains[j] * offsets[i].position_m[j]).norm();
      count += 1.0;
    }
  }
  return sum_m / std::max(count, 1.0);
}

}  // namespace ossa::recon
