#include "tools/learning/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ossa::tools {

void Calibration::Count(double confidence, bool is_hit) {
  const double bounded = std::clamp(confidence, 0.0, 1.0);
  const size_t bin = std::min(static_cast<size_t>(bounded * kBins), kBins - 1);
  ++joints_[bin];
  hits_[bin] += is_hit ? 1 : 0;
  confidence_sum_[bin] += bounded;
}

std::array<Calibration::Bin, Calibration::kBins> Calibration::Bins() const {
  std::array<Bin, kBins> bins;
  for (size_t b = 0; b < kBins; ++b) {
    bins[b].joints = joints_[b];
    bins[b].hits = hits_[b];
    if (joints_[b] > 0) {
      bins[b].mean_confidence = confidence_sum_[b] / static_cast<double>(joints_[b]);
    }
  }
  return bins;
}

double Calibration::ExpectedError() const {
  int64_t joints = 0;
  double error = 0;
  for (size_t b = 0; b < kBins; ++b) {
    joints += joints_[b];
    error += std::abs(static_cast<double>(hits_[b]) - confidence_sum_[b]);
  }
  return joints > 0 ? error / static_cast<double>(joints)
                    : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace ossa::tools
