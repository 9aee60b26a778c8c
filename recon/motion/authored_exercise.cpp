// Exercises of physiotherapy and functional movement screens.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "depth/base/angles.h"
#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

// Constants: of the authored body, anthropometry: a person of 1.75 m, rounded; the rest by eye.

using Eigen::Vector3d;

double SideSign(size_t side) { return side == 0 ? 1.0 : -1.0; }

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

/// Motion of the arms during leg exercises; drawn once per clip.
enum class Arms {
  kHanging,
  kForwards,
  kOverhead,
  kCrossed,
  kOnHips,
  kSpread,
  kBarOverhead,     // a long bar held up with a wide grip
  kBarOnShoulders,  // ... behind the neck: elbows bent, hands beside the shoulders or above
};

Arms DrawArms(Moves& m) { return static_cast<Arms>(m.Count(0, 7)); }

/// `lean`: forward lean of the chest, degrees, compensated so that arms are level in the room.
void HoldArms(BodyKey& key, Arms arms, double lean) {
  for (size_t s = 0; s < 2; ++s) {
    ArmKey& arm = key.arm[s];
    switch (arms) {
      case Arms::kHanging:
        arm = {4.0 + 0.8 * lean, 15.0, 0.97, 0.0, 10.0};
        break;
      case Arms::kForwards:
        arm = {86.0 + lean, 2.0, 0.97, 0.0, 30.0};
        break;
      case Arms::kOverhead:
        arm = {166.0, 14.0, 0.97, 0.0, 0.0};
        break;
      case Arms::kCrossed:
        ReachFor(key, s, {-0.1, -0.13 - 0.04 * static_cast<double>(s), 0.22});
        arm.swivel = 25.0;
        arm.pronate = 40.0;
        break;
      case Arms::kOnHips:
        ReachFor(key, s, {0.22, -0.42, 0.03});
        arm.swivel = 45.0;
        break;
      case Arms::kSpread:
        arm = {0.0, 88.0, 0.97, 0.0, 10.0};
        break;
      case Arms::kBarOverhead:
        arm = {0.0, 146.0, 0.95, 0.0, 0.0};
        break;
      case Arms::kBarOnShoulders:
        ReachFor(key, s, {0.36, 0.08, -0.02});
        arm.swivel = -10.0;
        break;
    }
  }
}

/// Arms first, then the legs.
void RaiseArmsFirst(Moves& m, Arms arms) {
  m.To(0.7, [&](BodyKey& key) { HoldArms(key, arms, 0.0); });
}

/// Thighs below horizontal, heels down, the trunk as upright as the hips allow.
void DeepSquat(Moves& m) {
  const Arms arms = m.Coin() ? Arms::kBarOverhead : DrawArms(m);
  const double half_m = m.Between(0.12, 0.24), toes = m.Between(4.0, 22.0);
  for (size_t s = 0; s < 2; ++s) {
    Vector3d foot = m.ease().leg[s].foot_m;
    foot.x() = SideSign(s) * half_m;
    Step(m, {s, foot, 0.0, 0.45, 0.03});
  }
  if (m.Coin()) RaiseArmsFirst(m, arms);
  for (int i = m.Count(2, 3); i > 0; --i) {
    const double depth_m = m.Between(0.3, 0.56), pitch = m.Between(8.0, 26.0),
                 bend = m.Between(8.0, 26.0);
    const BodyKey standing = m.now;
    m.To(m.Between(1.0, 1.6), [&](BodyKey& key) {
      key.balance = 1.0;
      key.pelvis_m.y() = depth_m;
      key.pitch = pitch;
      key.bend = bend;
      key.nod = -0.6 * (pitch + bend);
      for (LegKey& leg : key.leg) {
        leg.yaw = toes;
        leg.knee = m.Between(0.0, 12.0);
      }
      HoldArms(key, arms, pitch + bend);
    });
    m.Hold(m.Between(0.2, 0.5));
    m.To(m.Between(0.9, 1.4), [&](BodyKey& key) { key = standing; });
  }
  m.Ease(0.7);
}

/// One foot over a bar of knee height and back, the other leg straight.
void HurdleStep(Moves& m) {
  const Arms arms = DrawArms(m);
  RaiseArmsFirst(m, arms);
  for (int i = m.Count(2, 3); i > 0; --i) {
    const size_t side = m.Coin() ? 0 : 1;
    const double load = side == 0 ? 0.04 : 0.96, height_m = m.Between(0.26, 0.52);
    const Vector3d home = m.ease().leg[side].foot_m;
    const BodyKey standing = m.now;
    m.To(0.5, [&](BodyKey& key) {
      key.balance = 1.0;
      key.weight = load;
    });
    m.To(m.Between(0.6, 0.9), [&](BodyKey& key) {  // knee up to the hip, shin hanging
      key.leg[side].foot_m = home + Vector3d(0.0, height_m, m.Between(0.12, 0.3));
      key.leg[side].pitch = m.Between(0.0, 16.0);
      key.pitch = -m.Between(0.0, 8.0);
      key.roll = -SideSign(side) * m.Between(-2.0, 5.0);
    });
    m.To(m.Between(0.5, 0.8), [&](BodyKey& key) {  // the heel touches beyond the bar
      key.leg[side].foot_m = home + Vector3d(0.0, 0.03, m.Between(0.4, 0.55));
      key.leg[side].pitch = -12.0;
    });
    m.To(m.Between(0.5, 0.8), [&](BodyKey& key) {
      key.leg[side].foot_m = home + Vector3d(0.0, height_m, 0.2);
      key.leg[side].pitch = 10.0;
    });
    m.To(0.7, [&](BodyKey& key) { key = standing; });
  }
  m.Ease(0.6);
}

/// Heel before toe on one line, the back knee to the floor, the trunk upright.
void InlineLunge(Moves& m) {
  const Arms arms = DrawArms(m);
  const size_t side = m.Coin() ? 0 : 1;
  const double length_m = m.Between(0.55, 0.85);
  const Vector3d home = m.ease().leg[side].foot_m;
  Vector3d place = home + Vector3d(0.0, 0.0, length_m);
  place.x() *= m.Between(0.2, 1.0);
  Step(m, {side, place, 0.0, 0.7, 0.06});
  m.To(0.5, [&](BodyKey& key) {
    key.leg[side].pitch = 0.0;
    key.leg[1 - side].pitch = 35.0;
    key.twist = key.turn = 0.0;
    key.balance = 1.0;
    HoldArms(key, arms, 0.0);
  });
  for (int i = m.Count(2, 3); i > 0; --i) {
    m.To(m.Between(0.9, 1.3), [&](BodyKey& key) {
      key.pelvis_m.y() = m.Between(0.4, 0.58);
      key.pitch = m.Between(0.0, 10.0);
      key.bend = m.Between(0.0, 10.0);
      key.leg[1 - side].pitch = 55.0;
      HoldArms(key, arms, key.pitch + key.bend);
    });
    m.Hold(0.2);
    m.To(m.Between(0.8, 1.2), [&](BodyKey& key) {
      key.pelvis_m.y() = 0.8;
      key.leg[1 - side].pitch = 35.0;
    });
  }
  m.To(0.5, [&](BodyKey& key) { key.leg[1 - side].pitch = 12.0; });
  Step(m, {side, home, 0.0, 0.7, 0.08});
  m.Ease(0.6);
}

/// A wide step to the side, the weight over the bent knee, the other leg straight.
void SideLunge(Moves& m) {
  const Arms arms = m.Coin() ? Arms::kForwards : DrawArms(m);
  for (int i = m.Count(2, 3); i > 0; --i) {
    const size_t side = m.Coin() ? 0 : 1;
    const Vector3d home = m.ease().leg[side].foot_m;
    const double wide_m = m.Between(0.35, 0.55);
    Step(m, {side, home + Vector3d(SideSign(side) * wide_m, 0, 0), 0.0, 0.6, 0.06});
    m.To(m.Between(0.7, 1.1), [&](BodyKey& key) {
      key.balance = 1.0;
      key.weight = side == 0 ? 0.8 : 0.2;
      key.pelvis_m.y() = m.Between(0.42, 0.64);
      key.pitch = m.Between(14.0, 30.0);
      key.bend = m.Between(6.0, 24.0);
      key.nod = -0.5 * (key.pitch + key.bend);
      key.leg[side].yaw = m.Between(4.0, 18.0);
      HoldArms(key, arms, key.pitch + key.bend);
    });
    m.Hold(m.Between(0.2, 0.5));
    m.To(0.8, [&](BodyKey& key) {
      key.pelvis_m.y() = 0.8;
      key.pitch = key.bend = key.nod = 0.0;
      key.weight = 0.5;
      HoldArms(key, Arms::kHanging, 0.0);
    });
    Step(m, {side, home, 0.0, 0.6, 0.06});
  }
  m.Ease(0.6);
}

/// From a chair without the hands' help and down again.
void SitToStand(Moves& m) {
  const Arms arms = DrawArms(m);
  const double seat_m = m.Between(0.46, 0.6), back_m = m.Between(0.3, 0.42);
  RaiseArmsFirst(m, arms);
  for (int i = m.Count(2, 3); i > 0; --i) {
    const BodyKey standing = m.now;
    const double lean = m.Between(28.0, 46.0);
    const auto half_way = [&](BodyKey& key) {
      key.balance = 0.4;
      key.pelvis_m = Vector3d(0.0, 0.5 * (seat_m + 0.84), -0.5 * back_m);
      key.pitch = 0.55 * lean;
      key.bend = 0.45 * lean;
      key.nod = -0.4 * lean;
      HoldArms(key, arms, lean);
    };
    m.To(m.Between(0.6, 0.9), half_way);
    m.To(m.Between(0.6, 0.9), [&](BodyKey& key) {
      key.balance = 0.0;
      key.pelvis_m = Vector3d(0.0, seat_m, -back_m);
    });
    m.To(0.6, [&](BodyKey& key) {  // upright on the chair
      key.pitch = m.Between(-10.0, 6.0);
      key.bend = m.Between(-2.0, 10.0);
      key.nod = 0.0;
      HoldArms(key, arms, 0.0);
    });
    m.Hold(m.Between(0.2, 0.5));
    m.To(0.6, [&](BodyKey& key) {
      key.pitch = 0.6 * lean;
      key.bend = 0.4 * lean;
      key.nod = -0.4 * lean;
      HoldArms(key, arms, lean);
    });
    m.To(m.Between(0.5, 0.8), half_way);
    m.To(0.7, [&](BodyKey& key) { key = standing; });
  }
  m.Ease(0.6);
}

/// Lifts a straight leg to the front, side or back.
void LegRaise(Moves& m) {
  const Arms arms = DrawArms(m);
  RaiseArmsFirst(m, arms);
  for (int i = m.Count(2, 3); i > 0; --i) {
    const size_t side = m.Coin() ? 0 : 1;
    const Vector3d home = m.ease().leg[side].foot_m;
    const BodyKey standing = m.now;
    const int way = m.Count(0, 3);  // 0, 1: front
    m.To(0.5, [&](BodyKey& key) {
      key.balance = 1.0;
      key.weight = side == 0 ? 0.04 : 0.96;
    });
    m.To(m.Between(0.8, 1.2), [&](BodyKey& key) {
      LegKey& leg = key.leg[side];
      if (way <= 1) {
        const double height_m = m.Between(0.15, 0.5);
        leg.foot_m = home + Vector3d(0.0, height_m, 0.35 + 0.7 * height_m);
        leg.pitch = -90.0 * height_m;
        key.pitch = -20.0 * height_m;
      } else if (way == 2) {
        const double height_m = m.Between(0.08, 0.3);
        leg.foot_m = home + Vector3d(SideSign(side) * (0.3 + 0.7 * height_m), height_m, 0.0);
        key.roll = SideSign(side) * 25.0 * height_m;
        key.side = -SideSign(side) * m.Between(0.0, 12.0);
      } else {
        const double height_m = m.Between(0.08, 0.25);
        leg.foot_m = home + Vector3d(0.0, height_m, -0.35 - 0.5 * height_m);
        leg.pitch = 40.0;
        key.pitch = m.Between(4.0, 14.0);
      }
    });
    m.Hold(m.Between(0.2, 0.5));
    m.To(m.Between(0.8, 1.1), [&](BodyKey& key) { key = standing; });
  }
  m.Ease(0.6);
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

constexpr std::array<Action, 13> kActions = {{{"deep_squat", DeepSquat},
                                              {"hurdle_step", HurdleStep},
                                              {"inline_lunge", InlineLunge},
                                              {"side_lunge", SideLunge},
                                              {"sit_to_stand", SitToStand},
                                              {"leg_raise", LegRaise},
                                              {"shoulder_abduction", ShoulderAbduction},
                                              {"shoulder_scaption", ShoulderScaption},
                                              {"shoulder_flexion", ShoulderFlexion},
                                              {"shoulder_extension", ShoulderExtension},
                                              {"shoulder_rotation", ShoulderRotation},
                                              {"trunk_rotation", TrunkRotation},
                                              {"flank_stretch", FlankStretch}}};

}  // namespace

std::span<const Action> ExerciseActions() { return kActions; }

}  // namespace ossa::recon
