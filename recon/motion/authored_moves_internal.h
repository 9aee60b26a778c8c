#pragma once
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "recon/motion/authored_body_internal.h"

namespace ossa::recon {

/// A sequence of timed key postures under construction, in a performer style drawn from the seed
/// (stance, amplitude, tempo, sidedness). Actions modify `now` and add it as a key.
class Moves {
 public:
  explicit Moves(uint64_t seed);

  BodyKey now;
  const BodyKey& ease() const { return ease_; }  // this performer's relaxed stance

  /// Moves to the edited posture in `seconds` (times the performer's tempo).
  void To(double seconds, const std::function<void(BodyKey&)>& edit);
  void Hold(double seconds);
  /// Returns to the relaxed stance at the current foot positions.
  void Ease(double seconds);

  double Between(double low, double high);
  /// `value` scaled by the performer's amplitude and a random factor.
  double Size(double value);
  bool Coin();
  int Count(int low, int high);  // both included

  /// The clip: keys interpolated by monotone cubic curves (Fritsch & Carlson 1980: at rest at
  /// extrema, no overshoot), with slow sway of trunk, head and arms; mirrored for left-handed
  /// performers.
  std::vector<RigPose> Play(double frame_s) const;

 private:
  BodyKeyNumbers At(double time_s) const;
  BodyKey Swayed(BodyKeyNumbers numbers, double time_s) const;

  std::mt19937_64 random_;
  BodyKey ease_;
  double tempo_ = 1.0;
  double amplitude_ = 1.0;
  double sway_ = 1.0;
  bool mirrored_ = false;
  std::array<std::array<double, 3>, kBodyKeyNumbers> sway_phase_{};
  std::vector<double> times_s_;
  std::vector<BodyKeyNumbers> keys_;
};

/// A step of foot `side` to a position and heading in the world; the pelvis ends between the feet
/// with that heading. `lift_m` is the height of the sole halfway.
struct StepTo {
  size_t side = 0;
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();
  double heading = 0.0;  // of the body after the step, degrees
  double seconds = 0.55;
  double lift_m = 0.06;
};
/// `arms` edits the arms of the key where the foot lands.
void Step(
    Moves& moves, const StepTo& step, const std::function<void(BodyKey&)>& arms = [](BodyKey&) {});

/// Foot positions beside a body at `place_m` with heading `heading` degrees.
Eigen::Vector3d FootBeside(const BodyKey& ease, size_t side, const Eigen::Vector3d& place_m,
                           double heading);

struct Action {
  std::string_view name;
  void (*perform)(Moves&);
};

std::span<const Action> StandingActions();
std::span<const Action> WalkingActions();
std::span<const Action> SportActions();
std::span<const Action> HandActions();
std::span<const Action> SeatedActions();
std::span<const Action> LegExerciseActions();
std::span<const Action> UpperBodyExerciseActions();

}  // namespace ossa::recon
