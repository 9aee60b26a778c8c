#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "recon/models/pairs.h"

namespace ossa::recon {

// Constants: chosen by hand unless stated otherwise.

struct LinearFilterOptions {
  // Candidates for each joint; those with the smallest held-out error (AssignFolds) are used.
  std::vector<double> ridges = {1e-4, 1e-3, 1e-2, 1e-1,
                                1.0};  // relative to the mean square of a regressor
  // Weight of the squared error of second differences relative to that of position.
  std::vector<double> accelerations = {0.0, 1.0, 3.0, 10.0, 30.0};
  /// Trade-off between a relative change of position error and one of second differences. On
  /// UI-PRMD, each person left out in turn, 8 removes 79 % of acceleration error and loses 0.02 cm
  /// of the position error without offset; 32 removes 73 % and gains 0.02 cm; 12 leaves the
  /// position error unchanged.
  double position_share = 12.0;  // ratio; chosen so
};

/// Ours, used by `best`: a linear filter for each joint, learned from a sensor's output and the
/// truth (N. Wiener 1949, in discrete time: ridge regression of the error on the observation).
/// Stationary joints are unchanged. A joint has one of two kinds of weights:
///   steps: of the joint and of its neighbours, one bone away, in the body frame, with separate
///     weights per axis. They capture the sensor's delay, the direction of its noise, and noise
///     that neighbours share. Learned from several people;
///   influences: of the joint alone, a few weights shared by all axes. The farther another position
///     is from the estimated one, the less weight it may have, so gross errors can be learned, too.
///     Learned from one person: many weights would not generalise.
/// Left and right have the same weights, mirrored. A joint has weights only if, on held-out people
/// (of one person: on long blocks of time), they are better than LagFilter.
class LinearFilter {
 public:
  static constexpr int kSteps = 9;            // time steps in its input
  static constexpr int kFrames = kSteps + 1;  // maximum number of frames needed
  static constexpr int kFewest = 3;           // minimum number of steps
  static constexpr int kInfluencing = 4;      // frames before the estimated one with influence
  /// Limits of the frame time, of the format: slower and faster recordings are not learned from.
  static constexpr double kShortestStep_s = 1e-3, kLongestStep_s = 1.0;
  static bool CanLearnOf(double step_s) {
    return step_s > kShortestStep_s && step_s < kLongestStep_s;
  }
  /// Estimates of the newest frame, and of the one before it given the newest.
  enum Output { kNow = 0, kBefore = 1, kOutputs = 2 };
  /// Per joint: number of steps, up to the newest frame, in which it is trusted.
  using Steps = JointArray<int>;

  static LinearFilter Learn(const std::vector<PosturePair>& pairs,
                            const LinearFilterOptions& options = {});

  bool empty() const { return step_s == 0.0; }
  bool Knows(Output output, size_t joint) const { return WeightsOf(output, joint).size() > 0; }
  /// Whether a joint has influence weights, which need the joint observed but not trusted.
  bool Influences(Output output, size_t joint) const;
  bool HasInfluences() const;  // for any joint
  /// Whether the frame time is the learned one.
  bool IsStep(double dt_s) const { return std::abs(dt_s / step_s - 1.0) < 0.25; }
  /// The joint's position for each available output. `window`: postures in camera space, newest
  /// last, kFewest steps or more; step weights need the joint trusted in as many.
  std::array<Eigen::Vector3d, kOutputs> Estimate(size_t joint, std::span<const Posture> window,
                                                 const Steps& steps, double yaw_rad) const;

  // Public for the file. Weights of left and midline joints: regressors x 3 for steps, regressors x
  // 1 for influences, empty if not learned.
  double step_s = 0.0;  // 0: nothing was learned
  std::array<JointArray<Eigen::MatrixXf>, kOutputs> weights;

 private:
  const Eigen::MatrixXf& WeightsOf(Output output, size_t joint) const;
};

/// The joint whose weights are used: the joint itself, or for right joints the left one.
size_t LearnedSideOf(size_t joint);

/// Filter input for a joint: kSteps displacements of its own, oldest first, then of each neighbour,
/// metres, in the body frame; mirrored for right joints. Displacements from before the joint was
/// trusted are set to the mean of the later ones; a neighbour with too few moves like the joint.
Eigen::VectorXf FilterFeature(std::span<const Posture> window, const LinearFilter::Steps& steps,
                              double yaw_rad, size_t joint, bool mirrored);
/// Size of FilterFeature.
Eigen::Index FilterFeatureSize(size_t joint);

/// Influence regressors of a joint of which `steps` steps up to the newest frame are known: for
/// kInfluencing frames before the estimated one (as far back as known), and for kBefore also for
/// the newest, the displacement d from the estimated position in metres: d, d / (1 + |d|^2 / r^2)
/// with r = 5 cm, and the same with 15 cm (the influence function of the Cauchy distribution). 3 x
/// regressors, in camera space.
Eigen::Matrix3Xf InfluenceFeature(std::span<const Posture> window, int steps, size_t joint,
                                  LinearFilter::Output output);
/// Number of influence regressors for that output.
Eigen::Index InfluenceFeatureSize(LinearFilter::Output output);

}  // namespace ossa::recon
