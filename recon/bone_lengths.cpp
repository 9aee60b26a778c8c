#include "recon/bone_lengths.h"

#include <algorithm>
#include <cmath>

#include "depth/base/statistics.h"

namespace ossa::recon {
namespace {

/// Updates a running median with the n-th measurement. The first two are averaged: they may lie
/// farther from the length than a step of a few per cent.
double MoveMedian(double median_m, double length_m, int n) {
  constexpr double kFirstStep =
      0.5;  // step, share of the length over n; by hand, with the memory of 20 s
  if (n <= 2) return median_m + (length_m - median_m) / n;
  return median_m * (1.0 + std::copysign(kFirstStep / n, length_m - median_m));
}

}  // namespace

BoneLengthEstimator::BoneLengthEstimator(const BoneLengthOptions& options) : options_(options) {}

void BoneLengthEstimator::Add(size_t bone, double measured_m) {
  const size_t place = PlaceOf(bone);
  double& length_m = lengths_m_[place];
  int& n = counts_[place];
  n = std::min(n + 1, options_.memory);
  switch (options_.statistic) {
    case BoneStatistic::kMean:
      length_m += (measured_m - length_m) / n;
      break;
    case BoneStatistic::kExponential:
      length_m = (1.0 - options_.share) * length_m + options_.share * measured_m;
      break;
    case BoneStatistic::kRunningMedian:
      length_m = MoveMedian(length_m, measured_m, n);
      break;
    case BoneStatistic::kMedian:
      kept_m_[place].push_back(measured_m);
      break;
  }
}

void BoneLengthEstimator::Add(const BoneLengths& lengths_m) {
  for (size_t i = 1; i < kJointCount; ++i) Add(i, lengths_m[i]);
}

void BoneLengthEstimator::Start(size_t bone, double length_m) {
  lengths_m_[PlaceOf(bone)] = length_m;
}

void BoneLengthEstimator::StartKnown(const BoneLengths& lengths_m) {
  lengths_m_ = lengths_m;
  counts_.fill(options_.memory);
}

double BoneLengthEstimator::length_m(size_t bone) const {
  const size_t place = PlaceOf(bone);
  return kept_m_[place].empty() ? lengths_m_[place] : Median(kept_m_[place]);
}

BoneLengths BoneLengthEstimator::lengths_m() const {
  BoneLengths out{};
  for (size_t i = 1; i < kJointCount; ++i) out[i] = length_m(i);
  return out;
}

size_t BoneLengthEstimator::PlaceOf(size_t bone) const {
  return options_.sides_alike ? std::min(bone, kMirroredJoint[bone]) : bone;
}

}  // namespace ossa::recon
