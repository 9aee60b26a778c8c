#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "forest/forest.h"
#include "forest/propose.h"

namespace ossa::forest {

/// Weighted points of a density estimate, one array a coordinate (metres) for the vector units.
struct WeightedPoints {
  std::vector<float> x, y, z, weight;

  void Add(const Eigen::Vector3f& p_m, float w) {
    x.push_back(p_m.x());
    y.push_back(p_m.y());
    z.push_back(p_m.z());
    weight.push_back(w);
  }
  /// Drops the points from number `first` on that weigh less.
  void KeepHeavier(size_t first, float least) {
    size_t kept = first;
    for (size_t i = first; i < size(); ++i) {
      if (weight[i] < least) continue;
      x[kept] = x[i];
      y[kept] = y[i];
      z[kept] = z[i];
      weight[kept++] = weight[i];
    }
    for (auto* values : {&x, &y, &z, &weight}) values->resize(kept);
  }
  size_t size() const { return x.size(); }
  Eigen::Vector3f at(size_t i) const { return {x[i], y[i], z[i]}; }
};

/// Sum of weight · kernel and of weight · kernel · position.
struct KernelSum {
  float density = 0.0F;
  Eigen::Vector3f moment = Eigen::Vector3f::Zero();
};
KernelSum SumKernels(const WeightedPoints& points, const Eigen::Vector3f& at_m, float bandwidth_m);

/// One position vote of a pixel.
struct PositionVote {
  Eigen::Vector3f position_m;
  float spread_m = 0.0F;
  float distance_m = 0.0F;  // from the voting pixel
  float area_m2 = 0.0F;     // of the surface its pixel stands for
};

/// What an object's pixels say, before any target's parameters come in.
struct Evidence {
  int class_count = 0;
  std::vector<Eigen::Vector3f> surface_m;        // a sample of the pixels
  std::vector<float> area_m2;                    // of surface that each stands for
  std::vector<float> probability;                // sample × class
  std::vector<std::vector<PositionVote>> votes;  // a list a target
  float context_certainty = 1.0F;                // largest posterior
};
Evidence GatherEvidence(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, const Classification& classification);

/// A mode with what its confidence is computed from.
struct Mode {
  Eigen::Vector3f position_m = Eigen::Vector3f::Zero();
  float density = 0.0F;
  std::array<float, Confidence::kFeatures> feature{};
};
/// Modes of a target's density, densest first; none without evidence.
std::vector<Mode> FindModes(const Evidence& evidence, const ProposalTarget& target,
                            size_t target_index);

/// P by the logistic function.
template <size_t N>
double Evaluate(const Logistic<N>& logistic, const std::array<float, N>& feature) {
  double sum = logistic.bias;
  for (size_t i = 0; i < N; ++i) sum += logistic.weight[i] * feature[i];
  return 1.0 / (1.0 + std::exp(-sum));
}

}  // namespace ossa::forest
