#include "recon/refine/bone_measure.h"

#include <algorithm>
#include <cmath>

#include "recon/normalise.h"

namespace ossa::recon {
Eigen::VectorXf BoneNumbersOf(const ProposedPerson& person) {
  constexpr double kLeast_m = 0.01, kMost_m = 2.0;
  Eigen::VectorXf numbers(kBoneInputs);
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
  const Eigen::Vector3f middle_m = person.middle_m.cast<float>();
  std::copy(middle_m.begin(), middle_m.end(), next);
  return numbers;
}

Eigen::VectorXf BoneOutputsOf(const BoneLengths& lengths_m) {
  Eigen::VectorXf outputs(static_cast<Eigen::Index>(kMeasuredBones.size()));
  for (size_t b = 0; b < kMeasuredBones.size(); ++b) {
    const size_t left = Index(kMeasuredBones[b]), right = kMirroredJoint[left];
    const double length_m = (lengths_m[left] + lengths_m[right]) / 2.0;
    outputs[static_cast<Eigen::Index>(b)] =
        static_cast<float>(std::log(length_m / StandardBoneLengths()[left]) / kBoneStep);
  }
  return outputs;
}

BoneLengths MeasuredBones(const NetworkRunner& network, const ProposedPerson& person) {
  constexpr double kFarthest = 1.0;  // logarithm: whatever the network says, nobody is a giant
  Eigen::MatrixXf numbers(kBoneInputs, 2);
  numbers.col(0) = BoneNumbersOf(person);
  numbers.col(1) = BoneNumbersOf(person.Mirrored());
  const Eigen::VectorXd said = network.Run(numbers).cast<double>().rowwise().mean();
  BoneLengths lengths_m = StandardBoneLengths();
  for (size_t b = 0; b < kMeasuredBones.size(); ++b) {
    const size_t left = Index(kMeasuredBones[b]), right = kMirroredJoint[left];
    const double over = kBoneStep * said[static_cast<Eigen::Index>(b)];
    lengths_m[left] *= std::exp(std::clamp(over, -kFarthest, kFarthest));
    lengths_m[right] = lengths_m[left];
  }
  return lengths_m;
}

void JudgedBones::Add(const BoneLengths& judged_m) {
  constexpr int kMemory_frames = 600;
  frames = std::min(frames + 1, kMemory_frames);
  for (size_t i = 1; i < kJointCount; ++i) mean_m[i] += (judged_m[i] - mean_m[i]) / frames;
}

}  // namespace ossa::recon
