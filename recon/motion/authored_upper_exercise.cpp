// Exercises of arms and trunk of physiotherapy.
#include <array>
#include <cmath>
#include <numbers>

#include "depth/base/angles.h"
#include "recon/motion/authored_arms_internal.h"

namespace ossa::recon {
namespace {

// Constants: of the authored body, anthropometry: a person of 1.75 m, rounded; the rest by eye.

/// A straight arm `elevation` degrees from hanging, in the vertical plane turned `plane` degrees
/// from the side (0) to the front (90); the shoulder blade's own plane lies near 35.
void Elevate(ArmKey& arm, double elevation, double plane) {
  constexpr double kAtTheSide = 3.0;  // degrees
  if (plane < kAtTheSide) {
    arm.flex = 0.0;
    arm.abduct = elevation;
    return;
  }
  const double level = std::sin(elevation * kDegree), up = -std::cos(elevation * kDegree);
  arm.abduct = std::asin(level * std::cos(plane * kDegree)) / kDegree;
  arm.flex = std::atan2(level * std::sin(plane * kDegree), -up) / kDegree;
}

/// Straight arms up through one plane and down again, one or both: abduction (side), scaption
/// (shoulder blade), flexion (front).
void ElevateArms(Moves& m, double plane) {
  const int which = m.Count(0, 3);  // 0: left, 1: right, else both
  for (int i = m.Count(2, 3); i > 0; --i) {
    const double top = m.Between(80.0, 172.0), pronate = m.Between(-70.0, 40.0);
    const auto to = [&](double seconds, double elevation) {
      m.To(seconds, [&](BodyKey& key) {
        for (size_t s = which == 1 ? 1 : 0; s < (which == 0 ? 1u : 2u); ++s) {
          Elevate(key.arm[s], elevation, plane);
          key.arm[s].reach = 0.98;
          key.arm[s].pronate = pronate * elevation / top;
        }
        key.side = which > 1 ? 0.0 : (which == 0 ? -1.0 : 1.0) * 0.04 * elevation;
      });
    };
    // Intermediate keys keep the arm in the plane.
    for (const double part : {0.3, 0.55, 0.8, 1.0}) to(m.Between(0.3, 0.5), part * top);
    m.Hold(m.Between(0.2, 0.5));
    for (const double part : {0.7, 0.4}) to(0.4, part * top);
    to(0.5, 10.0);
  }
  m.Ease(0.6);
}

void ShoulderAbduction(Moves& m) { ElevateArms(m, 0.0); }
void ShoulderScaption(Moves& m) { ElevateArms(m, m.Between(22.0, 48.0)); }
void ShoulderFlexion(Moves& m) { ElevateArms(m, m.Between(76.0, 90.0)); }

/// One or both straight arms as far back as possible, the trunk upright or leaning a little.
void ShoulderExtension(Moves& m) {
  const int which = m.Count(0, 3);
  for (int i = m.Count(2, 4); i > 0; --i) {
    const double back = m.Between(25.0, 62.0), give = m.Between(0.0, 14.0);
    m.To(m.Between(0.7, 1.1), [&](BodyKey& key) {
      for (size_t s = which == 1 ? 1 : 0; s < (which == 0 ? 1u : 2u); ++s) {
        key.arm[s] = {-back, m.Between(8.0, 22.0), 0.97, 0.0, 0.0};
      }
      key.bend = m.ease().bend + give;
    });
    m.Hold(m.Between(0.2, 0.4));
    m.Ease(m.Between(0.7, 1.0));
  }
}

/// The upper arm is fixed, level to the side or at the trunk, the elbow at a right angle; the
/// forearm rotates.
void ShoulderRotation(Moves& m) {
  constexpr double kUpperArm_m = 0.26, kForearm_m = 0.23, kShoulder_m = 0.17;
  const bool level = m.Between(0.0, 1.0) < 0.65;
  const int which = m.Count(0, 3);
  for (int i = m.Count(4, 6); i > 0; --i) {
    // Angle of the forearm from straight ahead, degrees: up and down, or outwards and inwards.
    const double turn =
        i % 2 == 0 ? m.Between(50.0, 95.0) : (level ? m.Between(-80.0, -20.0) : -35.0);
    const double c = std::cos(turn * std::numbers::pi / 180.0),
                 s = std::sin(turn * std::numbers::pi / 180.0);
    m.To(m.Between(0.6, 1.0), [&](BodyKey& key) {
      for (size_t side = which == 1 ? 1 : 0; side < (which == 0 ? 1u : 2u); ++side) {
        if (level) {
          ReachFor(key, side, {kShoulder_m + kUpperArm_m, -0.07 + kForearm_m * s, kForearm_m * c});
          // Keeps the elbow at shoulder height wherever the wrist is.
          key.arm[side].swivel = 55.0 - 0.5 * turn;
        } else {
          ReachFor(key, side, {kShoulder_m + 0.06 + kForearm_m * s, -0.33, kForearm_m * c + 0.02});
          key.arm[side].swivel = -8.0;
        }
      }
    });
    m.Hold(m.Between(0.1, 0.3));
  }
  m.Ease(0.7);
}

/// Rotates the trunk as far as possible, arms spread or in front of the chest.
void TrunkRotation(Moves& m) {
  const Arms arms = m.Coin() ? Arms::kSpread : DrawArms(m);
  RaiseArmsFirst(m, arms);
  for (int i = m.Count(4, 5); i > 0; --i) {
    const double turn = (i % 2 == 0 ? 1.0 : -1.0) * m.Between(25.0, 55.0);
    m.To(m.Between(0.9, 1.3), [&](BodyKey& key) {
      key.turn = turn;
      key.twist = 0.4 * turn;
      key.look = 0.4 * turn;
      key.bend = m.Between(-2.0, 10.0);
    });
    m.Hold(0.2);
  }
  m.Ease(0.8);
}

/// One arm over the head, the trunk bent sideways away from it: stretches the flank.
void FlankStretch(Moves& m) {
  for (int i = m.Count(2, 4); i > 0; --i) {
    const size_t side = i % 2 == 0 ? 0 : 1;
    const double bend = m.Between(15.0, 36.0);
    const bool other_on_hip = m.Coin();
    m.To(m.Between(0.7, 1.0), [&](BodyKey& key) {
      key.arm[side] = {4.0, 150.0, 0.95, 0.0, 0.0};
      if (!other_on_hip) return;
      ReachFor(key, 1 - side, {0.22, -0.42, 0.03});
      key.arm[1 - side].swivel = 45.0;
    });
    m.To(m.Between(0.8, 1.1), [&](BodyKey& key) {
      key.side = -SideSign(side) * bend;
      key.tilt = 0.4 * key.side;
      key.arm[side].abduct = 164.0;
    });
    m.Hold(m.Between(0.3, 0.6));
    m.Ease(1.0);
  }
}

constexpr std::array<Action, 7> kUpperBodyExercises = {{{"shoulder_abduction", ShoulderAbduction},
                                                        {"shoulder_scaption", ShoulderScaption},
                                                        {"shoulder_flexion", ShoulderFlexion},
                                                        {"shoulder_extension", ShoulderExtension},
                                                        {"shoulder_rotation", ShoulderRotation},
                                                        {"trunk_rotation", TrunkRotation},
                                                        {"flank_stretch", FlankStretch}}};

}  // namespace

std::span<const Action> UpperBodyExerciseActions() { return kUpperBodyExercises; }

}  // namespace ossa::recon
