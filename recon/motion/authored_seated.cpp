#include <array>

#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

struct Seat {
  double hips_m;   // height of bone Hips above the floor when seated: about 9 cm above the seat
  double back_m;   // distance behind the feet
  double recline;  // of the trunk, degrees, positive backwards
};

Seat DrawSeat(Moves& m) {
  return {m.Between(0.46, 0.56), m.Between(0.34, 0.44), m.Between(-6.0, 18.0)};
}

void HandsOnLap(Moves& m, BodyKey& key) {
  for (size_t s = 0; s < 2; ++s) {
    ReachFor(key, s, {m.Between(0.06, 0.17), m.Between(-0.44, -0.38), m.Between(0.24, 0.34)});
    key.arm[s].pronate = m.Between(30.0, 80.0);
  }
}

void SitDown(Moves& m, const Seat& seat) {
  m.Hold(0.2);
  m.To(0.55, [&](BodyKey& key) {  // hips back, trunk forwards over the feet
    key.balance = 0.25;
    key.pelvis_m = Vector3d(0.0, 0.72, -0.55 * seat.back_m);
    key.pitch = 28.0;
    key.bend = 18.0;
    key.nod = -12.0;
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.2, -0.42, 0.28});
  });
  m.To(0.65, [&](BodyKey& key) {
    key.balance = 0.0;
    key.pelvis_m = Vector3d(0.0, seat.hips_m, -seat.back_m);
    key.pitch = 12.0;
    key.bend = 16.0;
  });
  m.To(0.6, [&](BodyKey& key) {
    key.pitch = -6.0 - 0.4 * seat.recline;
    key.bend = 6.0 - 0.6 * seat.recline;
    key.nod = 0.0;
    HandsOnLap(m, key);
  });
}

void StandUp(Moves& m, const Seat& seat) {
  m.To(0.6, [&](BodyKey& key) {
    key.pelvis_m = Vector3d(0.0, seat.hips_m, -0.92 * seat.back_m);
    key.pitch = 26.0;
    key.bend = 24.0;
    key.turn = key.side = key.look = 0.0;
    key.nod = -12.0;
    for (size_t s = 0; s < 2; ++s) key.leg[s] = m.ease().leg[s];
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.19, -0.44, 0.3});
  });
  m.To(0.5, [&](BodyKey& key) {
    key.balance = 0.4;
    key.pelvis_m = Vector3d(0.0, 0.68, -0.35 * seat.back_m);
    key.pitch = 24.0;
    key.bend = 12.0;
  });
  m.Ease(0.7);
}

void SeatedGesture(Moves& m) {
  m.To(m.Between(0.5, 0.9), [&](BodyKey& key) {
    const int kind = m.Count(0, 3);
    key.look = m.Between(-40.0, 40.0);
    key.turn = 0.4 * key.look;
    if (kind == 0) {
      HandsOnLap(m, key);
    } else if (kind == 1) {
      for (size_t s = 0; s < 2; ++s) {
        ReachFor(key, s, {m.Between(0.05, 0.35), m.Between(-0.35, 0.0), m.Between(0.25, 0.4)});
      }
    } else if (kind == 2) {
      key.arm[1] = {m.Between(40.0, 150.0), m.Between(0.0, 60.0), m.Between(0.7, 0.99), 0.0, 20.0};
    } else {  // leans on the knees
      key.bend = m.Between(20.0, 34.0);
      key.pitch = m.Between(8.0, 18.0);
      for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.1, -0.32, 0.36});
    }
  });
  m.Hold(m.Between(0.3, 0.7));
}

void Sit(Moves& m) {
  const Seat seat = DrawSeat(m);
  SitDown(m, seat);
  for (int i = m.Count(1, 3); i > 0; --i) SeatedGesture(m);
  StandUp(m, seat);
  m.Hold(0.2);
}

void SitCrossingLegs(Moves& m) {
  const Seat seat = DrawSeat(m);
  SitDown(m, seat);
  const size_t side = m.Coin() ? 0 : 1;
  const double sign = side == 0 ? 1.0 : -1.0;
  const bool ankle_on_knee = m.Coin();
  m.To(0.6, [&](BodyKey& key) {  // lifts the leg
    key.leg[side].foot_m = Vector3d(sign * 0.14, 0.32, 0.18);
    key.leg[side].pitch = 18.0;
    key.pitch -= 5.0;
    key.side = -sign * 4.0;
  });
  m.To(0.6, [&](BodyKey& key) {
    LegKey& leg = key.leg[side];
    if (ankle_on_knee) {
      leg.foot_m = Vector3d(-sign * 0.02, seat.hips_m - 0.04, 0.0);
      leg.knee = 62.0;
      leg.pitch = 12.0;
      leg.yaw = 40.0;
    } else {
      leg.foot_m = Vector3d(-sign * 0.17, seat.hips_m - 0.3, 0.2);
      leg.pitch = 22.0;
      leg.knee = -12.0;
    }
    HandsOnLap(m, key);
  });
  for (int i = m.Count(1, 2); i > 0; --i) SeatedGesture(m);
  m.To(0.6, [&](BodyKey& key) {
    key.leg[side].foot_m = Vector3d(sign * 0.14, 0.28, 0.18);
    key.leg[side].pitch = 15.0;
    key.leg[side].knee = 0.0;
    key.leg[side].yaw = m.ease().leg[side].yaw;
  });
  m.To(0.5, [&](BodyKey& key) {
    key.leg[side] = m.ease().leg[side];
    key.side = 0.0;
  });
  StandUp(m, seat);
}

constexpr std::array<Action, 2> kSeatedActions = {
    {{"sit", Sit}, {"sit_crossing_legs", SitCrossingLegs}}};

}  // namespace

std::span<const Action> SeatedActions() { return kSeatedActions; }

}  // namespace ossa::recon
