#pragma once
#include <Eigen/Core>
#include <functional>
#include <map>
#include <vector>

#include "recon/models/pairs.h"

namespace ossa::recon {

// Constants: by hand; one fold for each of the seven people of UI-PRMD.

struct PoseCorrectionOptions {
  int centres = 300;  // maximum number of inducing points; 0: no correction is learned
  // Candidates; those with the smallest error on held-out people are used. Widths of the kernel in
  // the feature's unit (a bone rotated by 90 degrees: 0.42); ridge: noise of a pair relative to the
  // signal.
  std::vector<double> widths = {0.6, 0.8, 1.2};
  std::vector<double> noise_ratios = {20.0, 80.0};
  int reweighings = 2;        // number of reweightings of the pairs by their error
  double gross_m = 0.3;       // frames with an error this large show another limb and are left out
  size_t most_pairs = 15000;  // evenly spread; each also mirrored
  int folds = 7;              // maximum, see AssignFolds
  uint64_t seed = 1;
  std::function<bool()> stop;  // true: stop with TrainInterrupted
};

/// Ours, used by `best`: the systematic part of a sensor's error as a function of the whole
/// posture. A sparse Gaussian process over all pairs (subset of regressors): Liu 2016 eq. 8 with
/// one kernel for all joints, on bone directions and lengths instead of positions, so that it
/// transfers between people. Its inducing points are means of ten or more observations (K-means),
/// so that no person's posture is in the file; a linear term extrapolates beyond the data. The fit
/// is robust: whole frames with a gross error are left out, the others are weighted by the inverse
/// of their error (iteratively reweighted least squares, approximately least absolute errors). Each
/// joint's offset is scaled by its held-out gain: sensors without systematic errors are not
/// corrected.
class PoseCorrection {
 public:
  PoseCorrection() = default;
  static PoseCorrection Learn(const std::vector<PosturePair>& pairs,
                              const PoseCorrectionOptions& options = {});

  bool empty() const { return weights.size() == 0; }
  /// Offsets to add to a complete scaled posture; zero for joints without known truth.
  Posture Offsets(const Posture& scaled) const;

  // Public for the file: centres (features x m), weights ((m + features) x 60), mean (60).
  Eigen::MatrixXf centres;
  Eigen::MatrixXf weights;
  Eigen::VectorXf mean;
  double width = 1.0;
  /// Mean true length of each bone relative to the standard one, of scaled people, below
  /// kMostProportion; 0 if the truth of an end is unknown or the length is implausible.
  BoneLengths proportions{};
  static constexpr double kMostProportion = 5.0;  // a ratio, of the format; by hand

 private:
  /// Held-out result of one choice of width and noise.
  struct HeldOut {
    JointWeights gains{};  // gain of each joint
    double error_m = 0.0;  // mean error with these gains
  };

  struct Samples;  // pairs prepared for a fit
  static Samples MakeSamples(std::vector<PosturePair> pairs, const PoseCorrectionOptions& options);
  static PoseCorrection Fit(const Samples& samples, double width, double noise_ratio,
                            const PoseCorrectionOptions& options);
  /// `rest`: by fold, the training data when it is held out.
  static HeldOut LeaveOut(const std::vector<PosturePair>& pairs, const std::vector<int>& fold,
                          const std::map<int, Samples>& rest, double width, double noise_ratio,
                          const PoseCorrectionOptions& options);
};

/// Directions (times 0.3 m) and lengths (times 3) of the 15 bones and lines that describe the
/// posture.
Eigen::VectorXf CorrectionFeature(const Posture& scaled);

}  // namespace ossa::recon
