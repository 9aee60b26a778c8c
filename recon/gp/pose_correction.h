#pragma once
#include <Eigen/Core>
#include <vector>

#include "recon/gp/pairs.h"

namespace ossa::recon {

struct PoseCorrectionOptions {
  int centres = 500;   // inducing postures
  double width = 0.7;  // of the kernel, in the feature's unit (a bone turned by 90 degrees: 0.42)
  double noise_ratio = 5.0;   // ridge: variance of a pair's noise over that of the signal
  size_t most_pairs = 15000;  // used, evenly spread; each also mirrored
  uint64_t seed = 1;
};

/// Ours, of `best`: the systematic part of a sensor's error as a function of the whole posture. A
/// Gaussian process over all pairs, sparse (subset of regressors with inducing postures): Liu 2016
/// eq. 8 with one kernel for all joints, on bone directions and lengths instead of positions, so
/// that it carries over between people. Far from all pairs it gives the mean offset.
class PoseCorrection {
 public:
  PoseCorrection() = default;
  static PoseCorrection Learn(const std::vector<PosturePair>& pairs,
                              const PoseCorrectionOptions& options = {});

  bool empty() const { return weights_.size() == 0; }
  /// Offsets to add to a complete scaled posture; zero for joints no truth was known of.
  Posture Offsets(const Posture& scaled) const;

  // Public for the file: centres (features x m), weights (m x 60), mean (60), which joints.
  Eigen::MatrixXf centres_;
  Eigen::MatrixXf weights_;
  Eigen::VectorXf mean_;
  double width_ = 1.0;
};

/// Directions (times 0.3 m) and lengths of the 15 bones and lines whose turn tells the posture.
Eigen::VectorXf CorrectionFeature(const Posture& scaled);

}  // namespace ossa::recon
