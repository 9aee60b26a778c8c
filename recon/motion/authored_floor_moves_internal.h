#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "depth/base/random.h"
#include "recon/motion/authored_body_internal.h"

namespace ossa::recon {

/// One leg by its joint angles in the pelvis' axes, degrees. On the floor, foot positions do not
/// determine the legs as they do in a LegKey.
struct LegAngles {
  double flex = 0.0;    // the thigh forwards
  double abduct = 0.0;  // outwards; for a forward thigh: about itself, the shin outwards
  double turn = 0.0;    // outwards about the trunk's length
  double knee = 0.0;    // bent
  double foot = 0.0;    // positive: toes away from the shin
};

/// Trunk and arms as in a BodyKey (its feet and balance are ignored), and the legs' angles.
struct FloorKey {
  BodyKey body;
  std::array<LegAngles, 2> leg;  // left, right
};

// By definition: the numbers of a FloorKey.
inline constexpr size_t kFloorNumbers = kBodyKeyNumbers + 10;
using FloorNumbers = std::array<double, kFloorNumbers>;

/// A sequence of timed keys under construction, interpolated with easing.
class FloorMoves {
 public:
  explicit FloorMoves(uint64_t seed);

  FloorKey now;

  /// Edits the current key; it is reached after `seconds`, times the clip's tempo.
  void To(double seconds, const std::function<void(FloorKey&)>& edit);
  void Hold(double seconds);
  double Between(double low, double high) { return random_.Uniform(low, high); }
  bool Coin() { return random_.Chance(0.5); }

  /// The lowest part of the body is on the floor in each frame.
  std::vector<RigPose> Play(double frame_s) const;

 private:
  void Put(double seconds);

  Random random_;
  double tempo_;
  bool mirrored_ = false;
  std::vector<double> times_s_;
  std::vector<FloorNumbers> keys_;
};

}  // namespace ossa::recon
