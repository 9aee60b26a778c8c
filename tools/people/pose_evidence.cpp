#include "tools/people/pose_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "recon/refine/person_crop.h"
#include "tools/people/candidate.h"

namespace ossa::people {
namespace {

// Weights of the terms of PoseTerms, written by `ossa experiment person-classifier`: kPoseWeights.
#include "tools/people/pose_weights.inc"

}  // namespace

std::optional<recon::NetworkPose> ReadPose(const recon::PoseNetwork& network,
                                           const depth::DepthFrame& frame,
                                           std::span<const int32_t> pixels) {
  const auto crop = recon::PersonCrop::Cut(frame, MaskPixels(frame, pixels));
  if (!crop) return std::nullopt;
  return network.Run(*crop);
}

double MeasureCertainty(const recon::NetworkPose& pose) {
  constexpr ptrdiff_t kSurestJoints = 5;  // joints, by hand: a head with shoulders, or a limb
  recon::JointArray<double> error_m = pose.error_m;
  std::ranges::nth_element(error_m, error_m.begin() + kSurestJoints);
  double sum = 0.0;
  for (ptrdiff_t k = 0; k < kSurestJoints; ++k) sum -= std::log(error_m[static_cast<size_t>(k)]);
  return sum / static_cast<double>(kSurestJoints);
}

std::array<double, 3> PoseTerms(double forest_score, double certainty) {
  // A score, by hand: on real furniture, too, the forest may be nearly certain.
  constexpr double kSurest = 0.95;
  const double score = std::clamp(forest_score, 1.0 - kSurest, kSurest);
  return {1.0, std::log(score / (1.0 - score)), certainty};
}

double ComputeScoreWithPose(double forest_score, double certainty) {
  const auto terms = PoseTerms(forest_score, certainty);
  const double sum = std::inner_product(terms.begin(), terms.end(), kPoseWeights.begin(), 0.0);
  return 1.0 / (1.0 + std::exp(-sum));
}

double MeasureDistance_m(const recon::NetworkPose& a, const recon::NetworkPose& b) {
  double sum_m = 0.0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    sum_m += (a.joints_m.position_m[j] - b.joints_m.position_m[j]).norm();
  }
  return sum_m / static_cast<double>(recon::kJointCount);
}

}  // namespace ossa::people
