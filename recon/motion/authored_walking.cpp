#include <array>
#include <cmath>
#include <numbers>

#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

Vector3d Ahead(double heading, double distance_m) {
  const double angle = heading * std::numbers::pi / 180.0;
  return {distance_m * std::sin(angle), 0.0, distance_m * std::cos(angle)};
}

/// Arms swing opposite to the legs, more forwards than back; elbows bend in front.
void SwingArms(BodyKey& key, size_t stepping_side, double degrees) {
  ArmKey& ahead = key.arm[1 - stepping_side];
  ArmKey& behind = key.arm[stepping_side];
  ahead.flex = 6.0 + degrees;
  ahead.reach = 0.95 - 0.002 * degrees;
  behind.flex = 4.0 - 0.85 * degrees;
  behind.reach = 0.975;
}

struct Gait {
  double step_m = 0.6;
  double seconds = 0.55;
  double lift_m = 0.05;
  double swing = 22.0;         // of the arms, degrees; 0: arms are posed separately
  double turn_per_step = 0.0;  // degrees
};

Gait DrawGait(Moves& m) {
  return {m.Between(0.42, 0.75), m.Between(0.48, 0.66), m.Between(0.03, 0.07), m.Size(24.0),
          m.Coin() ? 0.0 : m.Between(-18.0, 18.0)};
}

void WalkSteps(Moves& m, const Gait& gait, int steps, size_t first_side = 0) {
  Vector3d place = m.now.pelvis_m;
  place.y() = 0.0;
  double heading = m.now.heading;
  for (int i = 0; i < steps; ++i) {
    const size_t side = (first_side + static_cast<size_t>(i)) % 2;
    const bool last = i + 1 == steps;
    heading += last ? 0.0 : gait.turn_per_step;
    // The first step is a half one, the last closes the feet.
    place += last ? Vector3d::Zero() : Ahead(heading, i == 0 ? 0.6 * gait.step_m : gait.step_m);
    const StepTo step{side, FootBeside(m.ease(), side, place, heading), heading, gait.seconds,
                      gait.lift_m};
    Step(m, step, [&](BodyKey& key) {
      if (gait.swing > 0.0) SwingArms(key, side, last ? 0.3 * gait.swing : gait.swing);
    });
  }
}

void Walk(Moves& m) {
  const Gait gait = DrawGait(m);
  m.Hold(0.3);
  WalkSteps(m, gait, m.Count(6, 9));
  m.Ease(0.5);
  m.Hold(0.4);
}

void WalkBackAndForth(Moves& m) {
  Gait gait = DrawGait(m);
  gait.turn_per_step = 0.0;
  WalkSteps(m, gait, 5);
  gait.turn_per_step = 60.0;
  gait.step_m = 0.12;
  gait.swing *= 0.3;
  WalkSteps(m, gait, 4, 0);
  gait = DrawGait(m);
  gait.turn_per_step = 0.0;
  WalkSteps(m, gait, 5);
  m.Ease(0.5);
}

void TurnAround(Moves& m) {
  for (int turns = m.Count(2, 3); turns > 0; --turns) {
    Gait gait{0.03, m.Between(0.45, 0.65), 0.04, 5.0, m.Between(25.0, 60.0)};
    const int steps = m.Count(3, 5);
    if (m.Coin()) gait.turn_per_step = -gait.turn_per_step;
    m.To(0.3, [&](BodyKey& key) {
      key.look = 0.6 * gait.turn_per_step;
      key.turn = 0.2 * gait.turn_per_step;
    });
    WalkSteps(m, gait, steps, gait.turn_per_step > 0 ? 0 : 1);
    m.Ease(0.5);
    m.Hold(m.Between(0.3, 0.8));
  }
}

void SideSteps(Moves& m) {
  const double step_m = m.Size(0.3), seconds = m.Between(0.35, 0.5);
  Vector3d place = Vector3d::Zero();
  for (int half = 0; half < 2; ++half) {
    const size_t lead = static_cast<size_t>(half);
    const int steps = m.Count(2, 3);
    for (int i = 0; i < steps; ++i) {
      place.x() += lead == 0 ? step_m : -step_m;
      Step(m, {lead, FootBeside(m.ease(), lead, place, 0.0), 0.0, seconds, 0.05});
      Step(m, {1 - lead, FootBeside(m.ease(), 1 - lead, place, 0.0), 0.0, seconds, 0.05});
    }
  }
  m.Ease(0.4);
}

void March(Moves& m) {
  const double knee_m = m.Size(0.28), seconds = m.Between(0.35, 0.55), swing = m.Size(40.0);
  for (int i = m.Count(6, 9); i > 0; --i) {
    const auto side = static_cast<size_t>(i % 2);
    m.To(0.5 * seconds, [&](BodyKey& key) {
      key.weight = side == 0 ? 0.1 : 0.9;
      key.leg[side].foot_m.y() = knee_m;
      key.leg[side].foot_m.z() = m.ease().leg[side].foot_m.z() + 0.08;
      key.leg[side].pitch = 20.0;
      SwingArms(key, side, swing);
      key.arm[1 - side].reach = 0.8;
    });
    m.To(0.5 * seconds, [&](BodyKey& key) {
      key.leg[side] = m.ease().leg[side];
      key.weight = 0.5;
      SwingArms(key, side, 0.2 * swing);
    });
  }
  m.Ease(0.5);
}

void Carry(Moves& m) {
  const double width_m = m.Between(0.12, 0.22), height_m = m.Between(-0.45, -0.2);
  const auto hold = [&](BodyKey& key) {
    for (size_t s = 0; s < 2; ++s) {
      ReachFor(key, s, {width_m, height_m, 0.36});
      key.arm[s].pronate = -20.0;
      key.arm[s].swivel = 10.0;
    }
    key.bend = -4.0;
    key.lean_front_m = -0.01;
  };
  m.To(0.8, hold);
  Gait gait = DrawGait(m);
  gait.swing = 0.0;
  gait.step_m *= 0.8;
  WalkSteps(m, gait, m.Count(5, 7));
  m.Hold(0.3);
  m.To(0.7, [&](BodyKey& key) {  // puts it on a table
    key.balance = 1.0;
    key.bend = 22.0;
    key.pitch = 12.0;
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {width_m, -0.42, 0.42});
  });
  m.Ease(0.8);
}

constexpr std::array<Action, 6> kWalkingActions = {{{"walk", Walk},
                                                    {"walk_back_and_forth", WalkBackAndForth},
                                                    {"turn", TurnAround},
                                                    {"side_steps", SideSteps},
                                                    {"march", March},
                                                    {"carry", Carry}}};

}  // namespace

std::span<const Action> WalkingActions() { return kWalkingActions; }

}  // namespace ossa::recon
