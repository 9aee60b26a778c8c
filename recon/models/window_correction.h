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
  int64_t epochs = 12;        // of all pairs, each also mirrored
  float dropped = 0.3F;       // share of hidden units a step: people are few
  double gross_m = 0.3;       // a frame with a joint this far off shows another limb: left out
  size_t most_pairs = 40000;  // learned from, evenly spread
  size_t for_gains = 8000;    // pairs for the folds by which gains are found
  int folds = 3;              // of people left out, to find the gains
  uint64_t seed = 1;
  std::function<bool()> stop;  // true: end with TrainInterrupted soon
};

/// Ours, of `best`, beside PoseCorrection: the systematic part of a sensor's error as a function of
/// what the person did in the last half second. A multilayer perceptron over CorrectionFeature of
/// some frames, least distances, with dropout; the offsets of each joint are taken only as far as
/// they held on people left out. The mean of both corrections is taken: on people of UI-PRMD left
/// out it is nearer to the truth than PoseCorrection (`ossa experiment sdk`, best_window = 0).
/// Learned of several people only: of one nobody can be left out.
class WindowCorrection {
 public:
  /// Back in time from the frame that is corrected, seconds: hands move within tenths.
  static constexpr std::array<double, 5> kLags_s = {0.0, 0.07, 0.14, 0.27, 0.54};

  static WindowCorrection Learn(const std::vector<PosturePair>& pairs,
                                const WindowCorrectionOptions& options = {});

  bool empty() const { return network.empty(); }
  /// Offsets to add to a complete scaled posture, metres; `window`: CorrectionFeature at each of
  /// kLags_s before, one after the other. Precondition: not empty.
  Posture Offsets(const Eigen::VectorXf& window) const;

  // Public for the file.
  Perceptron network;
  JointWeights gains{};  // [0, 1]
};

/// Numbers in a window.
Eigen::Index WindowSize();

/// Features of one person over time, from which windows are cut.
class FeatureHistory {
 public:
  void Add(double time_s, Eigen::VectorXf feature);
  /// Ends with `now` at `time_s`; before it, at each lag, the feature nearest in time that was
  /// added until then, or `now` where none is nearer.
  Eigen::VectorXf WindowAt(double time_s, const Eigen::VectorXf& now) const;
  void Clear() { past_.clear(); }

 private:
  struct Moment {
    double time_s = 0.0;
    Eigen::VectorXf feature;
  };
  std::vector<Moment> past_;  // the newest last
};

}  // namespace ossa::recon
