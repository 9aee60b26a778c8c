#pragma once
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "forest/classification/classify.h"
#include "forest/forest.h"
#include "forest/proposals/modes_internal.h"
#include "forest/proposals/pose_inference_internal.h"
#include "forest/training/train.h"

namespace ossa::forest {

inline constexpr float kHitRadius_m = 0.10F;  // the measure of Shotton 2011

/// The evidence of an image, and its ground truth.
struct ValidationImage {
  depth::Camera camera;
  Evidence evidence;
  std::vector<float> context;  // posterior
  std::vector<Eigen::Vector3f> target_m;
  std::vector<uint8_t> target_visible;
};

Classification ClassifyImage(const ForestModel& model, const TrainingImage& image);
ValidationImage GatherImage(const ForestModel& model, const TrainingImage& image);

/// The results of the stages before the refinement.
struct FirstStage {
  TargetModes modes;
  PoseMarginals marginals;
};
FirstStage RunFirstStage(const ForestModel& model, const ValidationImage& image);

/// A mode or position with its features and ground truth.
template <size_t N>
struct Judged {
  std::array<float, N> feature{};
  bool is_near = false;  // near the target's true position
  bool visible = false;  // whether the target is visible
};
using JudgedMode = Judged<ModeConfidence::kFeatures>;

/// Logistic regression by Newton's method with a small ridge.
template <size_t N>
Logistic<N> FitLogistic(const std::vector<Judged<N>>& judged, bool Judged<N>::*outcome) {
  constexpr auto kSize = static_cast<Eigen::Index>(N) + 1;  // no unit; by definition
  // Equivalent to half an example: matters only if one outcome dominates; by hand
  constexpr double kRidge = 0.5;
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Square = Eigen::Matrix<double, kSize, kSize>;
  Vector w = Vector::Zero();
  for (int step = 0; step < 25; ++step) {
    Square hessian = kRidge * Square::Identity();
    Vector gradient = -kRidge * w;
    for (const Judged<N>& one : judged) {
      Vector x;
      for (Eigen::Index i = 0; i + 1 < kSize; ++i) x[i] = one.feature[static_cast<size_t>(i)];
      x[kSize - 1] = 1.0;
      const double p = 1.0 / (1.0 + std::exp(-std::clamp(w.dot(x), -30.0, 30.0)));
      gradient += ((one.*outcome ? 1.0 : 0.0) - p) * x;
      hessian += std::max(p * (1.0 - p), 1e-6) * x * x.transpose();
    }
    Vector move = hessian.ldlt().solve(gradient);
    if (move.norm() > 4.0) move *= 4.0 / move.norm();  // limits Newton's steps far from the optimum
    w += move;
    if (move.norm() < 1e-6) break;
  }
  Logistic<N> fitted;
  for (size_t i = 0; i < N; ++i) {
    fitted.weight[i] = static_cast<float>(w[static_cast<Eigen::Index>(i)]);
  }
  fitted.bias = static_cast<float>(w[kSize - 1]);
  return fitted;
}

/// A proposed position with its ground truth.
struct RatedPlace {
  double confidence = 0.0;
  bool is_near = false;
  bool visible = false;
  bool seen = false;  // according to the proposal
};

/// Sets the confidence thresholds above which a target is tracked (precision 0.9) and inferred
/// (0.5).
void SetThresholds(const std::vector<RatedPlace>& rated, ProposalTarget* target);

/// Learns the parameters of pose inference. Precondition: it has pose priors.
ForestModel LearnPoseInference(const ForestModel& model,
                               const std::vector<ValidationImage>& images);

}  // namespace ossa::forest
