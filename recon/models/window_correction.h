#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "depth/base/perceptron/perceptron.h"
#include "recon/models/pairs.h"

namespace ossa::recon {

// Constants: by hand, before anything was tested with them.

struct WindowCorrectionOptions {
  bool enabled = true;
  Eigen::Index hidden = 256;  // rectified units
  int64_t epochs = 12;        // over all pairs, each also mirrored
  float dropped = 0.3F;       // dropout, share of hidden units: there are few people
  double gross_m = 0.3;       // frames with an error this large show another limb and are left out
  size_t most_pairs = 40000;  // training pairs, evenly spread
  size_t for_gains = 8000;    // pairs for cross-validation of the gains
  int folds = 3;              // folds over people, for the gains
  uint64_t seed = 1;
  std::function<bool()> stop;  // true: stop with TrainInterrupted
};

/// Ours, used by `best` together with PoseCorrection: the systematic part of a sensor's error as a
/// function of the person's motion in the last half second. A multilayer perceptron on
/// CorrectionFeature of several frames, trained on distances, with dropout; offsets of each joint
/// are scaled by their held-out gain. The mean of both corrections is used: on held-out people of
/// UI-PRMD it is more accurate than PoseCorrection (`ossa experiment sdk`, best_window = 0).
/// Learned from several people only, because cross-validation needs to leave people out.
class WindowCorrection {
 public:
  /// Lags before the corrected frame, seconds: hands move within tenths.
  static constexpr std::array<double, 5> kLags_s = {0.0, 0.07, 0.14, 0.27, 0.54};

  static WindowCorrection Learn(const std::vector<PosturePair>& pairs,
                                const WindowCorrectionOptions& options = {});

  bool empty() const { return network.empty(); }
  /// Offsets to add to a complete scaled posture, metres; `window`: concatenated CorrectionFeature
  /// at each of kLags_s. Precondition: not empty.
  Posture Offsets(const Eigen::VectorXf& window) const;

  // Public for the file.
  Perceptron network;
  JointWeights gains{};  // [0, 1]
};

/// Size of a window.
Eigen::Index WindowSize();

/// Features of one person over time, the source of windows.
class FeatureHistory {
 public:
  void Add(double time_s, Eigen::VectorXf feature);
  /// The window ending with `now` at `time_s`: for each lag the stored feature nearest in time, or
  /// `now` if none is nearer.
  Eigen::VectorXf WindowAt(double time_s, const Eigen::VectorXf& now) const;
  void Clear() { past_.clear(); }

 private:
  struct Sample {
    double time_s = 0.0;
    Eigen::VectorXf feature;
  };
  std::vector<Sample> past_;  // the newest last
};

}  // namespace ossa::recon
