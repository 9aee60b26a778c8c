#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/filters/frame_steps.h"
#include "recon/posture.h"

namespace ossa::recon {

/// One joint, averaged while it does not move.
///
/// Where the forest sees a joint of somebody who stands still jumps from frame to frame without
/// memory (white noise, 3 mm at the neck to 35 mm at a hidden knee), so second differences measure
/// how much, whatever the joint does. The joint is still while the means of its last 1, 2, 4 ... 16
/// observations all agree, within that noise, with the mean of the time before; then the mean of
/// all is where it is. The first observation beyond the noise lets go: what moves passes unchanged
/// and without lag.
class StationaryAverage {
 public:
  Eigen::Vector3d Step(const Eigen::Vector3d& seen_m);
  void Forget() { *this = {}; }
  bool held() const { return frames_ > 0; }

 private:
  static constexpr int kWindow = 16;  // half a second, by hand

  const Eigen::Vector3d& Before(int frames) const;
  void LearnNoise();
  bool IsSamePlace(int last, const Eigen::Vector3d& mean_m, int frames) const;
  bool StaysAtMean() const;
  bool HasComeToRest() const;

  std::array<Eigen::Vector3d, kWindow> seen_m_;  // a ring
  int count_ = 0;                                // ever seen
  double variance_m2_ = 0.0;                     // of the noise, all three axes together
  Eigen::Vector3d mean_m_ = Eigen::Vector3d::Zero();
  int frames_ = 0;  // the mean is of; 0 while it moves
};

/// The joints of one body; what is not tracked is left alone and forgotten.
class StationaryPosture {
 public:
  TrackedPosture Step(const TrackedPosture& seen, double time_s);

 private:
  JointArray<StationaryAverage> joints_;
  FrameSteps steps_;
};

}  // namespace ossa::recon
