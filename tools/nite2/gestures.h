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
  Eigen::Vector3d hand_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d elbow_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d shoulder_m = Eigen::Vector3d::Zero();
};

/// Thresholds of gestures; by hand.
struct GestureOptions {
  double swing_m = 0.08;  // least distance between two turns of a wave
  int swings = 4;         // turns within ...
  double wave_s = 2.5;    // ... this time
  double push_m = 0.15;   // length of a click along the arm, and half of it back
  double push_s = 0.6;    // longest time of either direction
  double aside_m = 0.12;  // largest sideways motion of a click
  double towards = 0.5;   // cosine of the arm's angle to the sensor: within 60 degrees
  double raise_m = 0.05;  // height of a raised hand above the shoulder
  double raise_s = 0.3;   // time that it stays there
};

/// Detects one gesture in the path of one hand.
class GestureDetector {
 public:
  explicit GestureDetector(NiteGestureType type, const GestureOptions& options = {})
      : type_(type), options_(options) {}

  /// Adds a sample: NEW if a gesture may begin, IN_PROGRESS, or COMPLETED; else empty.
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
  // Wave: position of the last turn, direction, and times of turns.
  double extreme_m_ = 0.0;
  int way_ = 0;
  std::deque<double> turns_s_;
  // Click: recent samples, and the current push.
  std::deque<HandSample> past_;
  struct Push {
    // The hand as seen from the shoulder, where it began, and the farthest from there.
    Eigen::Vector3d from_m = Eigen::Vector3d::Zero(), way_m = Eigen::Vector3d::Zero();
    double end_s = 0.0;  // when it was there
  };
  std::optional<Push> pushed_;
  // Raise: since when, and whether it was reported.
  std::optional<double> raised_s_;
  bool told_ = false;
};

}  // namespace ossa::nite2
