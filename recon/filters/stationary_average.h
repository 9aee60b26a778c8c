#pragma once
#include <Eigen/Core>
#include <array>

#include "recon/filters/frame_steps.h"
#include "recon/posture.h"

namespace ossa::recon {

/// Averages one joint while it does not move.
///
/// The forest's position of a person who stands still has white noise (3 mm at the neck to 35 mm at
/// a hidden knee), so second differences measure its variance whatever the joint does. A joint is
/// still while the means of its last 1, 2, 4 ... 16 observations all agree, within that noise, with
/// the mean of the time before. Then the mean of all is returned. The first observation outside the
/// noise ends averaging: moving joints pass unchanged and without lag.
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

  std::array<Eigen::Vector3d, kWindow> seen_m_;  // ring buffer
  int count_ = 0;                                // observations so far
  double variance_m2_ = 0.0;                     // noise, sum over the three axes
  Eigen::Vector3d mean_m_ = Eigen::Vector3d::Zero();
  int frames_ = 0;  // in the mean; 0 while the joint moves
};

/// All joints of one body. Joints that are not tracked pass unchanged and are reset.
class StationaryPosture {
 public:
  TrackedPosture Step(const TrackedPosture& seen, double time_s);

 private:
  JointArray<StationaryAverage> joints_;
  FrameSteps steps_;
};

}  // namespace ossa::recon
