#pragma once
#include <vector>

#include "recon/models/pairs.h"

namespace ossa::recon {

/// Pairs without a gross error; all pairs if hardly any would remain.
std::vector<PosturePair> WithoutGrossErrors(const std::vector<PosturePair>& pairs, double gross_m);

/// The optimal gain of each joint on held-out pairs: least squares, g = sum(y o) / sum(o o),
/// weighted by the inverse of each error, so that a few gross errors do not dominate. In [0, 1]; 0
/// if less than half holds. `offsets`: predictions of models learned without the pair's fold.
JointWeights ComputeGains(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                          const std::vector<Posture>& offsets);

/// Mean distance of the known joints from the truth after adding offsets times gains, metres.
double ErrorLeft(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                 const std::vector<Posture>& offsets, const JointWeights& gains);

}  // namespace ossa::recon
