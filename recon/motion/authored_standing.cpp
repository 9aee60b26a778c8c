#include <array>

#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

void Stand(Moves& m) {
  for (int i = m.Count(3, 5); i > 0; --i) {
    m.To(m.Between(0.6, 1.2), [&](BodyKey& key) {
      key.weight = m.Between(0.15, 0.85);
      key.roll = 8.0 * (key.weight - 0.5);  // the hip of the standing leg is higher
      key.side = 0.8 * key.roll;
      key.look = m.Between(-50.0, 50.0);
      key.nod = m.Between(-10.0, 20.0);
      key.turn = 0.2 * key.look;
      key.leg[key.weight > 0.5 ? 1 : 0].knee = m.Between(0.0, 12.0);
    });
    m.Hold(m.Between(0.3, 1.0));
  }
}

void TPose(Moves& m) {
  const double abduct = m.Between(84.0, 94.0);
  m.Hold(0.3);
  m.To(1.0, [&](BodyKey& key) {
    for (ArmKey& arm : key.arm) arm = {0.0, abduct, 0.99, 0.0, m.Between(-10.0, 20.0)};
    key.bend = key.nod = 0.0;
  });
  m.Hold(1.0);
  m.To(0.8, [&](BodyKey& key) {  // then an A-pose
    for (ArmKey& arm : key.arm) arm.abduct = 45.0;
  });
  m.Hold(0.6);
  m.Ease(0.8);
}

void BendOver(Moves& m) {
  for (int i = m.Count(2, 3); i > 0; --i) {
    const double bend = m.Size(50.0), knees_m = m.Between(0.0, 0.12);
    m.To(1.1, [&](BodyKey& key) {
      key.bend = bend;
      key.pitch = 0.8 * bend;
      key.nod = m.Between(-15.0, 20.0);
      key.pelvis_m.y() = 0.85 - knees_m;
      for (ArmKey& arm : key.arm) arm = {m.Between(75.0, 105.0), 6.0, 0.97, 0.0, 30.0};
    });
    m.Hold(m.Between(0.2, 0.6));
    m.Ease(1.1);
  }
}

void BendSideways(Moves& m) {
  for (int i = m.Count(3, 4); i > 0; --i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0, side = sign * m.Size(32.0);
    const auto raised = static_cast<size_t>(sign > 0 ? 1 : 0);
    const bool with_arm = m.Coin();
    m.To(0.9, [&](BodyKey& key) {
      key.side = side;
      key.roll = -0.15 * side;
      key.tilt = 0.3 * side;
      key.arm[1 - raised].abduct = 4.0;
      if (with_arm) key.arm[raised] = {10.0, 155.0, 0.93, 0.0, 0.0};
    });
    m.Hold(0.3);
    m.Ease(0.8);
  }
}

void TwistTrunk(Moves& m) {
  const double height = m.Between(-0.35, -0.1), spread = m.Between(0.05, 0.45);
  m.To(0.6, [&](BodyKey& key) {
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {spread, height, 0.32});
  });
  for (int i = m.Count(4, 6); i > 0; --i) {
    const double turn = (i % 2 == 0 ? 1.0 : -1.0) * m.Size(38.0);
    m.To(0.7, [&](BodyKey& key) {
      key.turn = turn;
      key.twist = 0.35 * turn;
      key.look = 0.5 * turn;
    });
  }
  m.Ease(0.7);
}

/// Bends knees and back, hands to the floor in front of the feet.
void PickUp(Moves& m) {
  const double half_m = m.Between(0.08, 0.2), low_m = m.Between(0.08, 0.35);
  const bool one_hand = m.Coin();
  const double turn = m.Between(-25.0, 25.0);
  const auto hands_at = [&](BodyKey& key, double height_m, double front_m) {
    for (size_t s = one_hand ? 1 : 0; s < 2; ++s) {
      ReachForInWorld(key, s, {s == 0 ? half_m : -half_m, height_m, front_m});
    }
  };
  m.Hold(0.3);
  m.To(0.5, [&](BodyKey& key) {
    key.nod = 30.0;
    key.turn = 0.4 * turn;
  });
  m.To(0.9, [&](BodyKey& key) {
    key.pelvis_m.y() = m.Between(0.42, 0.65);
    key.bend = m.Between(35.0, 50.0);
    key.pitch = m.Between(25.0, 40.0);
    key.turn = turn;
    key.leg[0].knee = key.leg[1].knee = m.Between(4.0, 14.0);
    // The free hand hangs, whatever the trunk does.
    key.arm[0].flex = 0.85 * (key.bend + key.pitch);
    hands_at(key, low_m, 0.38);
  });
  m.Hold(0.35);
  m.To(1.0, [&](BodyKey& key) {  // up, the object held in front of the belly
    key = m.ease();
    key.bend = -3.0;
    for (size_t s = one_hand ? 1 : 0; s < 2; ++s) ReachFor(key, s, {half_m, -0.35, 0.33});
  });
  m.Hold(m.Between(0.5, 1.2));
  m.To(0.8, [&](BodyKey& key) {  // puts it on a shelf or table at the side
    key.turn = m.Between(-40.0, 40.0);
    key.look = 0.5 * key.turn;
    const double shelf_m = m.Between(-0.4, 0.25);
    for (size_t s = one_hand ? 1 : 0; s < 2; ++s) ReachFor(key, s, {half_m, shelf_m, 0.42});
  });
  m.Ease(0.9);
}

void Squat(Moves& m) {
  for (int i = m.Count(2, 4); i > 0; --i) {
    const double depth_m = m.Between(0.38, 0.62), arms = m.Between(55.0, 95.0);
    m.To(0.9, [&](BodyKey& key) {
      key.pelvis_m.y() = depth_m;
      key.pitch = 18.0;
      key.bend = m.Between(12.0, 28.0);
      key.nod = -15.0;
      for (ArmKey& arm : key.arm) arm = {arms, 3.0, 0.97, 0.0, 60.0};
      for (LegKey& leg : key.leg) leg.knee = m.Between(2.0, 14.0);
    });
    m.Hold(0.2);
    m.Ease(0.8);
  }
}

void Lunge(Moves& m) {
  for (int i = 0; i < 2; ++i) {
    const auto side = static_cast<size_t>(i);
    const double length_m = m.Between(0.55, 0.8), depth_m = m.Between(0.5, 0.65);
    const Vector3d home = m.ease().leg[side].foot_m;
    Step(m, {side, home + Vector3d(0, 0, length_m), 0.0, 0.75, 0.07});
    m.To(0.6, [&](BodyKey& key) {
      key.pelvis_m.y() = depth_m;
      key.pelvis_m.z() = 0.55 * length_m;
      key.leg[side].pitch = 0.0;
      key.leg[1 - side].pitch = 48.0;
      key.twist = key.turn = 0.0;
      for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.2, -0.4, 0.05});
      for (ArmKey& arm : key.arm) arm.swivel = 50.0;
    });
    m.Hold(0.4);
    m.To(0.5, [&](BodyKey& key) {
      key.pelvis_m.y() = 0.84;
      key.pelvis_m.z() = 0.4 * length_m;
      key.leg[1 - side].pitch = 12.0;
    });
    Step(m, {side, home, 0.0, 0.7, 0.08});
    m.Ease(0.5);
  }
}

constexpr std::array<Action, 8> kStandingActions = {{{"stand", Stand},
                                                     {"t_pose", TPose},
                                                     {"bend_over", BendOver},
                                                     {"bend_sideways", BendSideways},
                                                     {"twist_trunk", TwistTrunk},
                                                     {"pick_up", PickUp},
                                                     {"squat", Squat},
                                                     {"lunge", Lunge}}};

}  // namespace

std::span<const Action> StandingActions() { return kStandingActions; }

}  // namespace ossa::recon
