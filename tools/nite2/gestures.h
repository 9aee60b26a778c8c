#pragma once
#include <NiteCTypes.h>

#include <Eigen/Core>
#include <deque>
#include <optional>

namespace ossa::nite2 {

// Constants: by hand.

/// One hand at one time. Camera space, metres.
struct HandSample {
  double time_s = 0.0;
  Eigen::Vector3d hand_m, elbow_m, shoulder_m;
};

/// Thresholds of gestures; by hand.
struct GestureOptions {
  double swing_m = 0.08;  // a wave's least way between two turns
  int swings = 4;         // turns within ...
  double wave_s = 2.5;    // ... this time
  double push_m = 0.15;   // length of a click along the arm, and half of it back
  double push_s = 0.6;    // how long either way may take
  double aside_m = 0.12;  // how far a click may stray sideways
  double towards =
      0.5;  // part of the arm\'s direction that is towards the sensor: within 60 degrees
  double raise_m = 0.05;  // how far above the shoulder a raised hand is
  double raise_s = 0.3;   // how long it stays there
};

/// Detects one gesture in the path of one hand.
class GestureDetector {
 public:
  explicit GestureDetector(NiteGestureType type, const GestureOptions& options = {})
      : type_(type), options_(options) {}

  /// Adds a sample: NEW where a gesture may begin, IN_PROGRESS, or COMPLETED; none without a sign
  /// of it.
  std::optional<NiteGestureState> Step(const HandSample& sample);

 private:
  bool IsWaving(const HandSample& sample);
  bool IsClicking(const HandSample& sample);
  bool IsPush(const HandSample& before, const HandSample& now) const;
  bool IsRaising(const HandSample& sample);

  NiteGestureType type_;
  GestureOptions options_;
  bool begun_ = false;     // reported as NEW
  bool complete_ = false;  // the last step completed it
  // Wave: where the hand turned last, which way it goes, and when it turned.
  double extreme_m_ = 0.0;
  int way_ = 0;
  std::deque<double> turns_s_;
  // Click: the last moments, and the push that is under way.
  std::deque<HandSample> past_;
  struct Push {
    Eigen::Vector3d from_m;  // the hand as seen from the shoulder, where it began
    Eigen::Vector3d way_m;   // the farthest from there
    double end_s = 0.0;      // when it was there
  };
  std::optional<Push> pushed_;
  // Raise: since when, and whether it was reported.
  std::optional<double> raised_s_;
  bool told_ = false;
};

}  // namespace ossa::nite2
