#include "recon/refine/bone_estimation.h"

#include <algorithm>
#include <cmath>

#include "recon/normalise.h"

namespace ossa::recon {

// Constants: bounds, by hand.

Eigen::RowVectorXf ComputeBoneFeatures(const ProposedPerson& person) {
  constexpr double kLeast_m = 0.01, kMost_m = 2.0;
  Eigen::RowVectorXf numbers(kBoneFeatures);
  float* next = numbers.data();
  for (const Eigen::Vector3d& place_m : person.place.position_m) {
    const Eigen::Vector3f from_m = place_m.cast<float>();
    next = std::copy(from_m.begin(), from_m.end(), next);
  }
  const BoneLengths lengths_m = MeasureBoneLengths(person.place);
  for (size_t i = 1; i < kJointCount; ++i) {
    *next++ = static_cast<float>(std::log(std::clamp(lengths_m[i], kLeast_m, kMost_m)));
  }
  for (const double confidence : person.confidence) *next++ = static_cast<float>(confidence);
  for (const bool seen : person.seen) *next++ = seen ? 1.0F : 0.0F;
  const Eigen::Vector3f where_m = person.where_m.cast<float>();
  std::copy(where_m.begin(), where_m.end(), next);
  return numbers;
}

Eigen::RowVectorXf EncodeBoneLengths(const BoneLengths& lengths_m) {
  Eigen::RowVectorXf outputs(static_cast<Eigen::Index>(kEstimatedBones.size()));
  for (size_t b = 0; b < kEstimatedBones.size(); ++b) {
    const size_t left = Index(kEstimatedBones[b]), right = kMirroredJoint[left];
    const double length_m = (lengths_m[left] + lengths_m[right]) / 2.0;
    outputs[static_cast<Eigen::Index>(b)] =
        static_cast<float>(std::log(length_m / StandardBoneLengths()[left]) / kBoneStep);
  }
  return outputs;
}

BoneLengths EstimateBones(const QuantisedPerceptron& network, const ProposedPerson& person) {
  // Bound of the logarithm of a ratio, whatever the network predicts
  constexpr double kFarthest = 1.0;
  RowMatrix features(2, kBoneFeatures);
  features.row(0) = ComputeBoneFeatures(person);
  features.row(1) = ComputeBoneFeatures(person.Mirrored());
  const Eigen::RowVectorXd prediction = network.Run(features).cast<double>().colwise().mean();
  BoneLengths lengths_m = StandardBoneLengths();
  for (size_t b = 0; b < kEstimatedBones.size(); ++b) {
    const size_t left = Index(kEstimatedBones[b]), right = kMirroredJoint[left];
    const double over = kBoneStep * prediction[static_cast<Eigen::Index>(b)];
    lengths_m[left] *= std::exp(std::clamp(over, -kFarthest, kFarthest));
    lengths_m[right] = lengths_m[left];
  }
  return lengths_m;
}

}  // namespace ossa::recon
