#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "depth/base/lanes.h"
#include "forest/forest.h"
#include "forest/proposals/propose.h"

namespace ossa::forest {

/// Weighted points of a density estimate, one array per coordinate (metres) for vectorisation,
/// padded with points of zero weight.
class WeightedPoints {
 public:
  explicit WeightedPoints(size_t most) {
    for (auto* values : {&x_m, &y_m, &z_m, &weight}) values->resize(PaddedToLanes(most));
  }
  void Add(const Eigen::Vector3f& p_m, float w) {
    x_m[size_] = p_m.x();
    y_m[size_] = p_m.y();
    z_m[size_] = p_m.z();
    weight[size_++] = w;
  }
  size_t size() const { return size_; }
  Eigen::Vector3f at(size_t i) const { return {x_m[i], y_m[i], z_m[i]}; }

  std::vector<float> x_m, y_m, z_m, weight;

 private:
  size_t size_ = 0;
};

/// Sum of weight · kernel and of weight · kernel · position.
struct KernelSum {
  float density = 0.0F;
  Eigen::Vector3f moment = Eigen::Vector3f::Zero();
};
KernelSum SumKernels(const WeightedPoints& points, const Eigen::Vector3f& at_m, float bandwidth_m);
/// The density alone, in two thirds of the time.
float Density(const WeightedPoints& points, const Eigen::Vector3f& at_m, float bandwidth_m);

/// The evidence of an object's pixels, independent of targets: one array per quantity, one value
/// per sample, padded with zero-weight samples.
struct Evidence {
  int class_count = 0;
  size_t count = 0;                  // number of samples
  std::vector<float> x_m, y_m, z_m;  // surface
  std::vector<float> distance_m;     // distance of the surface from the camera
  std::vector<float> area_m2;        // surface area that the sample represents
  std::vector<float> probability;    // class × stride
  std::vector<Vote> votes;           // target × stride
  float context_certainty = 1.0F;    // largest posterior probability

  size_t stride() const { return area_m2.size(); }
  Eigen::Vector3f surface_m(size_t i) const { return {x_m[i], y_m[i], z_m[i]}; }
  const float* probability_of(size_t c) const { return probability.data() + c * stride(); }
  const Vote* votes_for(size_t target) const { return votes.data() + target * stride(); }
};
Evidence GatherEvidence(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, const Classification& classification);

/// The points of a target's density.
struct TargetPoints {
  WeightedPoints points;
  WeightedPoints surface;  // the part from classes, weights in reference areas
  float vote_total = 0.0F;
};
TargetPoints GatherPoints(const Evidence& evidence, const ProposalTarget& target,
                          size_t target_index);

/// A mode and the features of its confidence.
struct Mode {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();
  float density = 0.0F;
  std::array<float, ModeConfidence::kFeatures> feature{};
};
/// The modes of a target's density, by descending density; none without evidence.
std::vector<Mode> FindModes(const Evidence& evidence, const ProposalTarget& target,
                            size_t target_index);

/// Probability by the logistic function.
template <size_t N>
double Evaluate(const Logistic<N>& logistic, const std::array<float, N>& feature) {
  double sum = logistic.bias;
  for (size_t i = 0; i < N; ++i) sum += logistic.weight[i] * feature[i];
  return 1.0 / (1.0 + std::exp(-sum));
}

}  // namespace ossa::forest
