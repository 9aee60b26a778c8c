#pragma once
#include <vector>

#include "recon/models/pairs.h"

namespace ossa::recon {

/// Pairs without a gross error; all of them where hardly any is left.
std::vector<PosturePair> WithoutGrossErrors(const std::vector<PosturePair>& pairs, double gross_m);

/// The gain of each joint that is best on pairs left out: of least squares, g = sum(y o) / sum(o
/// o), weighed by the inverse of each error, so that a few gross ones do not decide. In [0, 1]; 0
/// where less than half holds. `offsets`: what was learned without the pair's fold says of it.
JointWeights ComputeGains(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                          const std::vector<Posture>& offsets);

/// Mean distance of the known joints from the truth, after offsets times gains, metres.
double ErrorLeft(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                 const std::vector<Posture>& offsets, const JointWeights& gains);

}  // namespace ossa::recon
