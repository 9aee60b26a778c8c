// Leg exercises of physiotherapy and functional movement screens.
#include <array>

#include "recon/motion/authored_arms_internal.h"

namespace ossa::recon {
namespace {

// Constants: of the authored body, anthropometry: a person of 1.75 m, rounded; the rest by eye.

using Eigen::Vector3d;

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

constexpr std::array<Action, 6> kLegExercises = {{{"deep_squat", DeepSquat},
                                                  {"hurdle_step", HurdleStep},
                                                  {"inline_lunge", InlineLunge},
                                                  {"side_lunge", SideLunge},
                                                  {"sit_to_stand", SitToStand},
                                                  {"leg_raise", LegRaise}}};

}  // namespace

std::span<const Action> LegExerciseActions() { return kLegExercises; }

}  // namespace ossa::recon
