#include "recon/filters/stationary_average.h"

#include <algorithm>

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

// Constants: by hand, checked on people who stand still in rendered clips.

// Threshold on the squared distance of two means, in variances: a still joint is released by
// mistake about once in 200 frames, and averaged again a frame later.
constexpr double kSamePlace = 7.0;
constexpr int kLongest = 60;           // frames in a mean, at most: people sway
constexpr double kNoiseMemory = 0.05;  // share of a new observation in the noise estimate
constexpr double kGrossNoise = 4.0;    // times the noise estimate: a jump, which is not noise
constexpr double kLeastNoise_m = 1e-3;

}  // namespace

const Vector3d& StationaryAverage::Before(int frames) const {
  return seen_m_[static_cast<size_t>((count_ - 1 - frames) % kWindow)];
}

// The second differences of white noise have six times its variance; motion adds only its
// acceleration, millimetres per frame squared.
void StationaryAverage::LearnNoise() {
  if (count_ < 3) return;
  const double now_m2 = (Before(0) - 2 * Before(1) + Before(2)).squaredNorm() / 6;
  const int pairs = count_ - 2;
  if (pairs * kNoiseMemory < 1) {  // arithmetic mean of the first ones
    variance_m2_ += (now_m2 - variance_m2_) / pairs;
    return;
  }
  const double most_m2 =
      kGrossNoise * kGrossNoise * std::max(variance_m2_, kLeastNoise_m * kLeastNoise_m);
  variance_m2_ += kNoiseMemory * (std::min(now_m2, most_m2) - variance_m2_);
}

// Whether the mean of the last `last` observations agrees with a mean over `frames` frames.
bool StationaryAverage::IsSamePlace(int last, const Vector3d& mean_m, int frames) const {
  Vector3d sum = Vector3d::Zero();
  for (int i = 0; i < last; ++i) sum += Before(i);
  const double noise_m2 = std::max(variance_m2_, kLeastNoise_m * kLeastNoise_m);
  return (sum / last - mean_m).squaredNorm() <
         kSamePlace * noise_m2 *
             (1.0 / static_cast<double>(last) + 1.0 / static_cast<double>(frames));
}

bool StationaryAverage::StaysAtMean() const {
  for (int last = 1; last <= kWindow; last *= 2) {
    if (!IsSamePlace(last, mean_m_, frames_)) return false;
  }
  return true;
}

bool StationaryAverage::HasComeToRest() const {
  if (count_ < kWindow) return false;
  for (int last = 1; last <= kWindow / 2; last *= 2) {
    Vector3d sum = Vector3d::Zero();
    for (int i = last; i < kWindow; ++i) sum += Before(i);
    if (!IsSamePlace(last, sum / (kWindow - last), kWindow - last)) return false;
  }
  return true;
}

Vector3d StationaryAverage::Step(const Vector3d& seen_m) {
  ++count_;
  seen_m_[static_cast<size_t>((count_ - 1) % kWindow)] = seen_m;
  if (held() && StaysAtMean()) {
    frames_ = std::min(frames_ + 1, kLongest);
    mean_m_ += (seen_m - mean_m_) / frames_;
  } else if (HasComeToRest()) {
    frames_ = kWindow;
    mean_m_.setZero();
    for (const Vector3d& p : seen_m_) mean_m_ += p / kWindow;
  } else {
    frames_ = 0;
  }
  LearnNoise();
  return held() ? mean_m_ : seen_m;
}

TrackedPosture StationaryPosture::Step(const TrackedPosture& seen, double time_s) {
  if (!steps_.To(time_s)) joints_ = {};
  TrackedPosture averaged = seen;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (seen.state[j] == TrackingState::kNotTracked) {
      joints_[j].Forget();
    } else {
      averaged.posture.position_m[j] = joints_[j].Step(seen.posture.position_m[j]);
    }
  }
  return averaged;
}

}  // namespace ossa::recon
