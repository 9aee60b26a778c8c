#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "recon/models/pairs.h"

namespace ossa::recon {

// Constants: by hand; folds are the seven people of UI-PRMD.

struct PoseCorrectionOptions {
  int centres = 300;  // inducing points, at most; 0: no correction is learned
  // Tried in turn; those that hold best for people left out are taken. Widths of the kernel in the
  // feature's unit (a bone turned by 90 degrees: 0.42); ridge: a pair's noise over the signal.
  std::vector<double> widths = {0.6, 0.8, 1.2};
  std::vector<double> noise_ratios = {20.0, 80.0};
  int reweighings = 2;        // of the pairs, by their error in the fit before
  double gross_m = 0.3;       // a frame with a joint this far off shows another limb: left out
  size_t most_pairs = 15000;  // used, evenly spread; each also mirrored
  int folds = 7;              // at most, left out in turn, see AssignFolds
  uint64_t seed = 1;
  std::function<bool()> stop;  // true: end with TrainInterrupted soon
};

/// Ours, of `best`: the systematic part of a sensor's error as a function of the whole posture. A
/// Gaussian process over all pairs, sparse (subset of regressors): Liu 2016
/// eq. 8 with one kernel for all joints, on bone directions and lengths instead of positions, so
/// that it carries over between people. Its inducing points are means of ten and more observations
/// (K-means), so that no one's posture is in the file; a linear term beside it carries on where
/// pairs end. Each fit is robust: whole frames with a gross error are left out, the others weighed
/// by the inverse of their error (iteratively reweighed least squares: nearly least absolute
/// errors). Each joint's offset is taken only as far as it held on pairs left out: a sensor whose
/// errors have no system is left alone.
class PoseCorrection {
 public:
  PoseCorrection() = default;
  static PoseCorrection Learn(const std::vector<PosturePair>& pairs,
                              const PoseCorrectionOptions& options = {});

  bool empty() const { return weights.size() == 0; }
  /// Offsets to add to a complete scaled posture; zero for joints no truth was known of.
  Posture Offsets(const Posture& scaled) const;

  // Public for the file: centres (features x m), weights ((m + features) x 60), mean (60).
  Eigen::MatrixXf centres;
  Eigen::MatrixXf weights;
  Eigen::VectorXf mean;
  double width = 1.0;
  /// Mean true length of each bone over the standard one, of scaled people, below kMostProportion;
  /// 0 where no truth was known of both ends, or one that is nobody's bone.
  BoneLengths proportions{};
  static constexpr double kMostProportion = 5.0;  // a ratio, of the format; by hand

 private:
  /// How one choice of width and noise does on people left out.
  struct HeldOut {
    JointWeights gains{};  // of each joint
    double error_m = 0.0;  // mean, with those gains
  };

  struct Samples;  // pairs made ready for a fit
  static Samples MakeSamples(std::vector<PosturePair> pairs, const PoseCorrectionOptions& options);
  static PoseCorrection Fit(const Samples& samples, double width, double noise_ratio,
                            const PoseCorrectionOptions& options);
  /// `rest`: by fold, what is learned from when it is left out.
  static HeldOut LeaveOut(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                          const std::map<int, Samples>& rest, double width, double noise_ratio,
                          const PoseCorrectionOptions& options);
};

/// Directions (times 0.3 m) and lengths (times 3) of the 15 bones and lines whose turn tells the
/// posture.
Eigen::VectorXf CorrectionFeature(const Posture& scaled);

}  // namespace ossa::recon
