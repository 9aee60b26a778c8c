#include <array>

#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

void WidenStance(Moves& m, double half_m, double seconds) {
  for (size_t s = 0; s < 2; ++s) {
    Vector3d foot = m.ease().leg[s].foot_m;
    foot.x() = s == 0 ? half_m : -half_m;
    Step(m, {s, foot, 0.0, seconds, 0.04});
  }
}

/// Both hands on the club at `place`, the right one below the left. Rotation of the chest carries
/// the hands, so the place is given in the chest's axes (outwards from the shoulder line of either
/// side).
void GripClub(BodyKey& key, const Vector3d& place) {
  ReachFor(key, 0, place + Vector3d(0.0, 0.02, 0.0));
  ReachFor(key, 1, Vector3d(-place.x(), place.y() - 0.05, place.z() + 0.01));
}

void AddressBall(BodyKey& key) {
  key.balance = 1.0;
  key.pelvis_m.y() = 0.8;
  key.pitch = 24.0;
  key.bend = 14.0;
  key.nod = 12.0;
  key.turn = key.twist = key.side = key.look = 0.0;
  key.weight = 0.5;
  key.leg[1].pitch = 0.0;
  GripClub(key, {0.0, -0.5, 0.3});
}

/// A right-handed swing with feet wide apart.
void Golf(Moves& m) {
  WidenStance(m, 0.2, 0.4);
  const double size = m.Between(0.7, 1.05), top = 78.0 * size;
  m.To(0.8, AddressBall);
  m.Hold(0.6);
  m.To(0.8, [&](BodyKey& key) {  // backswing
    key.turn = -0.6 * top;
    key.twist = -0.4 * top;
    key.look = 0.7 * top;
    key.weight = 0.25;
    GripClub(key, Vector3d(-0.2, -0.12 + 0.18 * size, 0.3));
  });
  m.To(0.3, [&](BodyKey& key) {  // impact
    key.turn = 10.0;
    key.twist = 20.0;
    key.look = -15.0;
    key.weight = 0.7;
    key.leg[1].pitch = 12.0;
    GripClub(key, {0.02, -0.5, 0.32});
  });
  m.To(0.4, [&](BodyKey& key) {  // follow-through
    key.turn = 0.55 * top;
    key.twist = 0.75 * top;
    key.look = 0.0;
    key.pitch = 4.0;
    key.bend = -4.0;
    key.weight = 0.9;
    key.leg[1].pitch = 45.0;
    GripClub(key, {0.2, 0.08, 0.26});
  });
  m.Hold(0.7);
  m.To(0.9, AddressBall);
  m.Ease(0.8);
}

void Guard(BodyKey& key) {
  for (size_t s = 0; s < 2; ++s) {
    ReachFor(key, s, {0.1, -0.06 - 0.04 * static_cast<double>(s), 0.24});
    key.arm[s].swivel = 5.0;
    key.arm[s].pronate = 15.0;
  }
  key.turn = -14.0;
  key.look = 22.0;
  key.nod = 8.0;
  key.bend = 8.0;
}

void BoxingStance(Moves& m) {
  Step(m, {0, m.ease().leg[0].foot_m + Vector3d(0.02, 0, m.Between(0.2, 0.32)), -8.0, 0.45, 0.04});
  m.To(0.4, [&](BodyKey& key) {
    key.balance = 1.0;
    key.pelvis_m.y() = m.Between(0.76, 0.82);
    key.twist = -18.0;
    key.leg[0].pitch = 0.0;
    key.leg[1].pitch = 14.0;
    Guard(key);
  });
}

void Punch(Moves& m) {
  BoxingStance(m);
  const BodyKey guard = m.now;
  for (int i = m.Count(5, 8); i > 0; --i) {
    const size_t side = m.Coin() ? 0 : 1;
    const int kind = m.Count(0, 3);  // 0, 1: straight; 2: hook; 3: uppercut
    const double height_m = m.Between(-0.25, 0.12);
    m.To(m.Between(0.16, 0.26), [&](BodyKey& key) {
      const double sign = side == 0 ? 1.0 : -1.0;
      key.turn = -sign * (side == 0 ? 22.0 : 30.0);
      key.twist = side == 0 ? -28.0 : 12.0;
      key.look = -0.6 * key.turn;
      key.weight = side == 0 ? 0.6 : 0.75;
      if (kind <= 1) {
        ReachFor(key, side, {0.08, height_m, 0.5});
        key.arm[side].pronate = 70.0;
      } else if (kind == 2) {
        ReachFor(key, side, {0.02, height_m, 0.36});
        key.arm[side].swivel = 70.0;
      } else {
        ReachFor(key, side, {0.1, 0.1, 0.33});
        key.arm[side].pronate = -70.0;
      }
    });
    m.To(m.Between(0.22, 0.35), [&](BodyKey& key) { key = guard; });
    if (m.Coin()) m.Hold(m.Between(0.1, 0.5));
  }
  m.Ease(0.6);
}

void KickOnce(Moves& m) {
  const size_t side = m.Between(0.0, 1.0) < 0.7 ? 1 : 0;
  const double sign = side == 0 ? 1.0 : -1.0;
  const double height_m = m.Between(0.25, 0.85), out_m = m.Between(-0.05, 0.3);
  const Vector3d home = m.ease().leg[side].foot_m;
  const double load = side == 0 ? 0.06 : 0.94;
  m.To(0.5, [&](BodyKey& key) {  // weight over, foot back
    key.balance = 1.0;
    key.weight = load;
    key.leg[side].foot_m = home + Vector3d(0, 0.06, -0.25);
    key.leg[side].pitch = 35.0;
    key.arm[side].flex = 25.0;
    key.arm[1 - side].flex = -20.0;
  });
  m.To(0.22, [&](BodyKey& key) {  // knee first
    key.leg[side].foot_m = home + Vector3d(sign * 0.3 * out_m, 0.5 * height_m, 0.2);
    key.leg[side].pitch = 30.0;
    key.pitch = -6.0;
  });
  m.To(0.2, [&](BodyKey& key) {
    key.leg[side].foot_m = home + Vector3d(sign * out_m, height_m, 0.75);
    key.leg[side].pitch = 10.0 - 60.0 * height_m;
    key.pitch = -16.0;
    key.bend = 4.0;
    key.twist = -sign * 12.0;
    key.arm[side].flex = -25.0;
    key.arm[1 - side] = {50.0, 20.0, 0.85, 0.0, 0.0};
  });
  m.To(0.35, [&](BodyKey& key) {
    key.leg[side].foot_m = home + Vector3d(0, 0.2, 0.15);
    key.leg[side].pitch = 20.0;
    key.pitch = 0.0;
  });
  m.To(0.35, [&](BodyKey& key) {
    key = m.ease();
    key.weight = 0.5;
  });
  m.Hold(m.Between(0.2, 0.5));
}

void Kick(Moves& m) {
  for (int i = m.Count(2, 3); i > 0; --i) KickOnce(m);
}

/// Slow weight shifts in a deep, wide stance, arms drawing large curves: parting, pushing, cloud
/// hands.
void TaiChi(Moves& m) {
  WidenStance(m, m.Between(0.24, 0.34), 0.8);
  const double height_m = m.Between(0.68, 0.78);
  double side_of_weight = m.Coin() ? 1.0 : -1.0;
  for (int i = m.Count(4, 5); i > 0; --i) {
    side_of_weight = -side_of_weight;
    const int form = m.Count(0, 2);
    const size_t upper = side_of_weight > 0 ? 0 : 1;
    m.To(m.Between(1.1, 1.6), [&](BodyKey& key) {
      key.balance = 1.0;
      key.pelvis_m.y() = height_m + m.Between(-0.03, 0.03);
      key.weight = 0.5 + 0.32 * side_of_weight;
      key.turn = side_of_weight * m.Between(15.0, 32.0);
      key.twist = 0.5 * key.turn;
      key.look = 0.4 * key.turn;
      key.bend = m.Between(-2.0, 6.0);
      if (form == 0) {  // parting: one hand up in front, the other down at the hip
        ReachFor(key, upper, {m.Between(0.15, 0.3), 0.02, 0.42});
        ReachFor(key, 1 - upper, {0.26, -0.45, 0.12});
      } else if (form == 1) {  // pushing with both
        for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.15, m.Between(-0.12, 0.0), 0.44});
      } else {  // cloud hands: one hand in front of the face, one of the belly
        ReachFor(key, upper, {0.08, 0.0, 0.34});
        ReachFor(key, 1 - upper, {-0.02, -0.36, 0.3});
      }
      key.arm[upper].pronate = m.Between(-40.0, 20.0);
      key.arm[1 - upper].pronate = m.Between(20.0, 80.0);
      for (ArmKey& arm : key.arm) arm.swivel = m.Between(5.0, 25.0);
    });
  }
  m.Ease(1.2);
}

void JumpingJacks(Moves& m) {
  const double wide_m = m.Between(0.28, 0.42), up = m.Between(135.0, 168.0);
  const double beat = m.Between(0.22, 0.32), hop_m = m.Between(0.03, 0.08);
  for (int i = m.Count(8, 12); i > 0; --i) {
    const bool open = i % 2 == 0;
    const auto spread = [&](BodyKey& key, double part) {
      for (size_t s = 0; s < 2; ++s) {
        const double narrow_m = std::abs(m.ease().leg[s].foot_m.x());
        key.leg[s].foot_m.x() = (s == 0 ? 1.0 : -1.0) * (narrow_m + part * (wide_m - narrow_m));
        key.arm[s] = {4.0, 14.0 + part * (up - 14.0), 0.96, 0.0, 10.0};
      }
    };
    m.To(beat, [&](BodyKey& key) {  // in the air
      spread(key, 0.5);
      for (LegKey& leg : key.leg) {
        leg.foot_m.y() = hop_m;
        leg.pitch = 28.0;
      }
      key.pelvis_m.y() = 0.86 + hop_m;
    });
    m.To(beat, [&](BodyKey& key) {  // landed, knees giving
      spread(key, open ? 1.0 : 0.0);
      for (LegKey& leg : key.leg) {
        leg.foot_m.y() = 0.0;
        leg.pitch = 4.0;
      }
      key.pelvis_m.y() = open ? 0.79 : 0.83;
    });
  }
  m.Ease(0.5);
}

void Throw(Moves& m) {
  Step(m, {0, m.ease().leg[0].foot_m + Vector3d(0, 0, 0.3), -10.0, 0.5, 0.04});
  for (int i = m.Count(2, 3); i > 0; --i) {
    const double height_m = m.Between(0.0, 0.25);
    m.To(0.6, [&](BodyKey& key) {
      key.balance = 1.0;
      key.leg[0].pitch = 0.0;
      key.weight = 0.2;
      key.turn = -35.0;
      key.twist = -25.0;
      key.look = 45.0;
      key.arm[1] = {15.0, 85.0, 0.6, 10.0, 0.0};
      ReachFor(key, 1, {0.38, height_m, -0.12});
      ReachFor(key, 0, {0.15, -0.1, 0.4});
    });
    m.To(0.3, [&](BodyKey& key) {
      key.weight = 0.85;
      key.turn = 20.0;
      key.twist = 12.0;
      key.look = -20.0;
      key.bend = 14.0;
      key.leg[1].pitch = 25.0;
      ReachFor(key, 1, {0.12, 0.16, 0.48});
      ReachFor(key, 0, {0.22, -0.35, 0.12});
    });
    m.To(0.3, [&](BodyKey& key) {
      key.turn = 32.0;
      key.bend = 22.0;
      ReachFor(key, 1, {-0.12, -0.35, 0.36});
    });
    m.Ease(0.8);
  }
}

constexpr std::array<Action, 6> kSportActions = {{{"golf", Golf},
                                                  {"punch", Punch},
                                                  {"kick", Kick},
                                                  {"tai_chi", TaiChi},
                                                  {"jumping_jacks", JumpingJacks},
                                                  {"throw", Throw}}};

}  // namespace

std::span<const Action> SportActions() { return kSportActions; }

}  // namespace ossa::recon
