#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "recon/models/pairs.h"

namespace ossa::recon {

// Constants: chosen by hand, where no comparison is said.

struct LinearFilterOptions {
  // Tried in turn for each joint; those that hold best for what is left out (AssignFolds) are
  // taken.
  std::vector<double> ridges = {1e-4, 1e-3, 1e-2, 1e-1,
                                1.0};  // over the mean square of a regressor
  // Squared error of second differences over squared error of position, in what is minimised.
  std::vector<double> accelerations = {0.0, 1.0, 3.0, 10.0, 30.0};
  /// What a hundredth less error of position is worth, in hundredths less of second differences. On
  /// UI-PRMD, each person left out in turn, 8 takes 79 % of acceleration and gives offset removed
  /// 0.02 cm back, 32 takes 73 % and 0.02 cm more: with 12 the position is what it was.
  double position_share = 12.0;  // ratio; chosen so
};

/// Ours, of `best`: a filter of fixed weights for each joint, learned from what a sensor said and
/// what was true (N. Wiener 1949, in discrete time: ridge regression of the error on what was
/// seen). What stands still it leaves alone. The weights of a joint are of one of two kinds:
///   steps: of the joint and of its neighbours, each a bone away, in the body's frame, weights of
///     their own for every axis: it knows the sensor's delay, which way its noise lies and what
///     neighbours share of it. Learned of several people;
///   influences: of the joint alone, the same few weights for all axes. The farther another
///   position is
///     from the one that is estimated, the less it may weigh, so that gross errors are learned of
///     too. Of one person: many weights would not hold for anybody else.
/// Left and right have the same weights, mirrored. A joint has weights only where, on people left
/// out (of one person: on long blocks of time), they do better than LagFilter does.
class LinearFilter {
 public:
  static constexpr int kSteps = 9;            // from frame to frame, that it sees
  static constexpr int kFrames = kSteps + 1;  // at most, that it needs
  static constexpr int kFewest = 3;           // steps of a joint, for it to count
  static constexpr int kInfluencing = 4;      // frames before the one estimated that influence it
  /// Between frames, of the format: of slower and faster recordings nothing is learned.
  static constexpr double kShortestStep_s = 1e-3, kLongestStep_s = 1.0;
  static bool CanLearnOf(double step_s) {
    return step_s > kShortestStep_s && step_s < kLongestStep_s;
  }
  /// Of the newest frame, and of the one before it once the newest is known.
  enum Output { kNow = 0, kBefore = 1, kOutputs = 2 };
  /// Of each joint: so many steps, up to the newest frame, are believed.
  using Steps = JointArray<int>;

  static LinearFilter Learn(const std::vector<PosturePair>& pairs,
                            const LinearFilterOptions& options = {});

  bool empty() const { return step_s == 0.0; }
  bool Knows(Output output, size_t joint) const { return WeightsOf(output, joint).size() > 0; }
  /// Whether its weights are of influences, which need a joint in the window but not believed
  /// there.
  bool Influences(Output output, size_t joint) const;
  bool HasInfluences() const;  // of any joint
  /// Whether the step from frame to frame is the one that was learned of.
  bool IsStep(double dt_s) const { return std::abs(dt_s / step_s - 1.0) < 0.25; }
  /// Where the joint is, of each output that is known. `window`: postures in camera space, the
  /// newest last, kFewest steps or more; weights of steps need the joint believed in as many.
  std::array<Eigen::Vector3d, kOutputs> Estimate(size_t joint, std::span<const Posture> window,
                                                 const Steps& steps, double yaw_rad) const;

  // Public for the file. Of joints of the left and the middle: of steps regressors x 3, of
  // influences regressors x 1, empty: not learned.
  double step_s = 0.0;  // 0: nothing is known
  std::array<JointArray<Eigen::MatrixXf>, kOutputs> weights;

 private:
  const Eigen::MatrixXf& WeightsOf(Output output, size_t joint) const;
};

/// The joint whose weights a joint has: its own or, of the right, those of the left.
size_t LearnedSideOf(size_t joint);

/// What the filter sees of a joint: kSteps steps of its own, oldest first, then of each neighbour,
/// metres, in the body's frame; of a right joint mirrored. Steps from before a joint was believed
/// are taken to be the mean of those after; a neighbour with too few moves as the joint does.
Eigen::VectorXf FilterFeature(std::span<const Posture> window, const LinearFilter::Steps& steps,
                              double yaw_rad, size_t joint, bool mirrored);
/// Numbers that the filter reads of a joint.
Eigen::Index FilterFeatureSize(size_t joint);

/// How other positions of a joint influence it, of which `steps` up to the newest frame are known:
/// for kInfluencing frames before the one estimated (as far back as is known), and of kBefore for
/// the newest too, the way there d in metres: d, d / (1 + |d|^2 / r^2) with r = 5 cm, the same with
/// 15 cm (the influence function of Cauchy's distribution). 3 x regressors, in camera space.
Eigen::Matrix3Xf InfluenceFeature(std::span<const Posture> window, int steps, size_t joint,
                                  LinearFilter::Output output);
/// Numbers of a joint's influence features for that output.
Eigen::Index InfluenceFeatureSize(LinearFilter::Output output);

}  // namespace ossa::recon
