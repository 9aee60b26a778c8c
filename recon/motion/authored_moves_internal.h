#pragma once
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <string_view>
#include <vector>

#include "recon/motion/authored_body_internal.h"

namespace ossa::recon {

/// A choreography under way: key postures with their times, and the mover's own style drawn from
/// the seed (stance, amplitude, tempo, sidedness). Actions change `now` and put it down as a key.
class Moves {
 public:
  explicit Moves(uint64_t seed);

  BodyKey now;
  const BodyKey& ease() const { return ease_; }  // how this mover stands

  /// Goes to the edited posture in `seconds` (times the mover's tempo).
  void To(double seconds, const std::function<void(BodyKey&)>& edit);
  void Hold(double seconds);
  /// Back to the mover's easy stance where the feet are now.
  void Ease(double seconds);

  double Between(double low, double high);
  /// `value` more or less by the mover's amplitude and a share of chance.
  double Size(double value);
  bool Coin();
  int Count(int low, int high);  // both included

  /// The clip: keys joined by monotone cubic curves (Fritsch & Carlson 1980: rest at turning
  /// points, no overshoot), with slow sway of trunk, head and arms; mirrored for left-sided movers.
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

/// One step of foot `side` to a place and direction in the world; the pelvis ends between the feet,
/// heading there. `lift_m` is the height of the sole halfway.
struct StepTo {
  size_t side = 0;
  Eigen::Vector3d foot_m = Eigen::Vector3d::Zero();
  double heading = 0.0;  // degrees, of the body after the step
  double seconds = 0.55;
  double lift_m = 0.06;
};
/// `arms` edits the arms of the key where the foot lands.
void Step(
    Moves& moves, const StepTo& step, const std::function<void(BodyKey&)>& arms = [](BodyKey&) {});

/// Foot places beside a body at `place_m` heading `heading` degrees.
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
std::span<const Action> ExerciseActions();

}  // namespace ossa::recon
