#include <array>
#include <cmath>
#include <numbers>

#include "recon/motion/authored_moves_internal.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

void Point(Moves& m) {
  for (int i = m.Count(3, 4); i > 0; --i) {
    const size_t side = m.Between(0.0, 1.0) < 0.75 ? 1 : 0;  // mostly the dominant hand
    m.To(m.Between(0.5, 0.8), [&](BodyKey& key) {
      ArmKey& arm = key.arm[side];
      arm = {m.Between(50.0, 125.0), m.Between(-30.0, 75.0), m.Between(0.94, 0.99), 0.0, 40.0};
      const double sign = side == 0 ? 1.0 : -1.0;
      key.look = sign * 0.6 * arm.abduct;
      key.turn = sign * 0.25 * arm.abduct;
      key.nod = 0.3 * (90.0 - arm.flex);
    });
    m.Hold(m.Between(0.4, 0.9));
    if (m.Coin()) m.Ease(0.6);
  }
  m.Ease(0.7);
}

void Wave(Moves& m) {
  const bool both = m.Between(0.0, 1.0) < 0.3;
  const double height_m = m.Between(-0.02, 0.42), out_m = m.Between(0.24, 0.38);
  const double width_m = m.Between(0.06, 0.16), front_m = m.Between(0.02, 0.25);
  const auto hand_at = [&](BodyKey& key, double part) {
    for (size_t s = both ? 0 : 1; s < 2; ++s) {
      ReachFor(key, s, {out_m + part * width_m, height_m - 0.03 * std::abs(part), front_m});
      key.arm[s].pronate = 50.0;
    }
  };
  m.Hold(0.3);
  m.To(0.7, [&](BodyKey& key) { hand_at(key, 0.0); });
  for (int i = m.Count(5, 9); i > 0; --i) {
    m.To(m.Between(0.22, 0.34), [&](BodyKey& key) { hand_at(key, i % 2 == 0 ? 1.0 : -1.0); });
  }
  m.To(0.3, [&](BodyKey& key) { hand_at(key, 0.0); });
  m.Ease(0.8);
}

void Clap(Moves& m) {
  const double height_m = m.Between(-0.3, 0.1), front_m = m.Between(0.26, 0.36);
  const double open_m = m.Between(0.12, 0.3), beat = m.Between(0.18, 0.32);
  const auto hands_at = [&](BodyKey& key, double out_m) {
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {out_m, height_m, front_m});
  };
  m.To(0.7, [&](BodyKey& key) { hands_at(key, open_m); });
  for (int i = m.Count(7, 11); i > 0; --i) {
    m.To(beat, [&](BodyKey& key) { hands_at(key, 0.035); });
    m.To(beat, [&](BodyKey& key) { hands_at(key, open_m); });
  }
  m.Ease(0.7);
}

void CrossArms(Moves& m) {
  const double height_m = m.Between(-0.3, -0.2);
  m.Hold(0.3);
  m.To(0.6, [&](BodyKey& key) {
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.12, height_m, 0.3});
  });
  m.To(0.6, [&](BodyKey& key) {  // one forearm above and in front of the other
    ReachFor(key, 0, {-0.09, height_m + 0.03, 0.25});
    ReachFor(key, 1, {-0.07, height_m - 0.04, 0.19});
    for (ArmKey& arm : key.arm) arm.swivel = 12.0;
    key.bend += 3.0;
  });
  for (int i = m.Count(1, 2); i > 0; --i) {
    m.To(m.Between(0.6, 1.2), [&](BodyKey& key) {
      key.weight = m.Between(0.2, 0.8);
      key.roll = 7.0 * (key.weight - 0.5);
      key.look = m.Between(-35.0, 35.0);
    });
    m.Hold(0.5);
  }
  m.To(0.5, [&](BodyKey& key) {
    for (size_t s = 0; s < 2; ++s) ReachFor(key, s, {0.14, height_m - 0.05, 0.3});
  });
  m.Ease(0.6);
}

/// Forearms roll about each other in front of the chest, drifting along `drift`.
void RollHands(Moves& m, const Vector3d& drift) {
  const double radius_m = m.Between(0.06, 0.1), beat = m.Between(0.12, 0.18);
  const double start = m.Between(-0.02, 0.05);
  const double sense = m.Coin() ? 1.0 : -1.0;
  const auto hands_at = [&](BodyKey& key, double phase, double along) {
    for (size_t s = 0; s < 2; ++s) {
      const double angle = sense * phase + (s == 0 ? 0.0 : std::numbers::pi);
      ReachFor(key, s,
               Vector3d(0.02, -0.2, 0.33 + start) + along * drift +
                   radius_m * Vector3d(0.0, std::sin(angle), std::cos(angle)));
      key.arm[s].swivel = 25.0;
      key.arm[s].pronate = 60.0;
    }
  };
  m.To(0.7, [&](BodyKey& key) { hands_at(key, 0.0, 0.0); });
  const int beats = m.Count(22, 30);
  for (int i = 1; i <= beats; ++i) {
    const double along = std::sin(2.0 * std::numbers::pi * i / 14.0);
    m.To(beat, [&](BodyKey& key) { hands_at(key, 0.25 * std::numbers::pi * i, along); });
  }
  m.Ease(0.7);
}

void RollHandsUpDown(Moves& m) { RollHands(m, {0.0, m.Size(0.2), 0.0}); }
void RollHandsForwardBackward(Moves& m) { RollHands(m, {0.0, 0.0, m.Size(0.08)}); }

void HandsOnHips(Moves& m) {
  const bool both = m.Between(0.0, 1.0) < 0.7;
  m.Hold(0.3);
  m.To(0.7, [&](BodyKey& key) {
    for (size_t s = both ? 0 : 1; s < 2; ++s) {
      ReachFor(key, s, {m.Between(0.19, 0.22), m.Between(-0.42, -0.36), m.Between(-0.02, 0.05)});
      key.arm[s].swivel = m.Between(30.0, 60.0);
      key.arm[s].pronate = 30.0;
    }
  });
  for (int i = m.Count(2, 3); i > 0; --i) {
    m.To(m.Between(0.6, 1.0), [&](BodyKey& key) {
      key.weight = m.Between(0.15, 0.85);
      key.roll = 8.0 * (key.weight - 0.5);
      key.turn = m.Between(-18.0, 18.0);
      key.look = m.Between(-40.0, 40.0);
      key.bend = m.Between(-6.0, 10.0);
    });
    m.Hold(0.3);
  }
  m.Ease(0.7);
}

/// Hands at the head: behind it, on top, at the ear as with a telephone, at mouth or brow.
void HandsToHead(Moves& m) {
  for (int i = m.Count(2, 3); i > 0; --i) {
    const bool both = m.Coin();
    static constexpr std::array<std::array<double, 3>, 5> kPlaces = {{{0.15, 0.19, -0.04},
                                                                      {0.15, 0.25, 0.06},
                                                                      {0.15, 0.1, 0.12},
                                                                      {0.1, 0.04, 0.21},
                                                                      {0.14, 0.16, 0.2}}};
    const auto& place = kPlaces[static_cast<size_t>(m.Count(0, 4))];
    m.To(0.8, [&](BodyKey& key) {
      for (size_t s = both ? 0 : 1; s < 2; ++s) {
        ReachFor(key, s, Vector3d(place[0], place[1], place[2]));
        key.arm[s].swivel = m.Between(-5.0, 25.0);
      }
      key.nod = m.Between(-5.0, 12.0);
    });
    m.Hold(m.Between(0.5, 1.0));
    m.Ease(0.8);
  }
}

void RaiseArms(Moves& m) {
  for (int i = m.Count(3, 4); i > 0; --i) {
    const bool front = m.Coin();
    const int which = m.Count(0, 3);  // 0, 1: both arms
    const double height = m.Between(70.0, 165.0);
    m.To(0.9, [&](BodyKey& key) {
      for (size_t s = 0; s < 2; ++s) {
        if (which >= 2 && s != static_cast<size_t>(which - 2)) continue;
        ArmKey& arm = key.arm[s];
        arm.flex = front ? height : m.Between(-5.0, 15.0);
        arm.abduct = front ? m.Between(-5.0, 20.0) : height;
        arm.reach = m.Between(0.85, 0.99);
      }
      key.nod = -0.12 * height;
      key.bend = -0.03 * height;
    });
    m.Hold(m.Between(0.2, 0.7));
    if (m.Coin()) m.Ease(0.9);
  }
  m.Ease(0.9);
}

/// Reaches with one or both hands to places all around, supported by the trunk, sometimes bending
/// down.
void ReachAround(Moves& m) {
  for (int i = m.Count(4, 6); i > 0; --i) {
    m.To(m.Between(0.6, 1.0), [&](BodyKey& key) {
      const bool low = m.Between(0.0, 1.0) < 0.25;
      for (size_t s = 0; s < 2; ++s) {
        if (m.Between(0.0, 1.0) < 0.35) continue;
        key.arm[s] = {m.Between(-35.0, 165.0), m.Between(-25.0, 85.0), m.Between(0.65, 0.99),
                      m.Between(-15.0, 35.0), m.Between(-20.0, 60.0)};
        // Keeps hands from reaching across behind the back.
        if (key.arm[s].flex < 20.0) key.arm[s].abduct = std::abs(key.arm[s].abduct) + 12.0;
      }
      key.turn = m.Between(-35.0, 35.0);
      key.side = m.Between(-12.0, 12.0);
      key.bend = low ? m.Between(15.0, 40.0) : m.Between(-6.0, 14.0);
      key.pitch = low ? m.Between(10.0, 30.0) : m.Between(-2.0, 6.0);
      key.look = m.Between(-40.0, 40.0);
      key.weight = m.Between(0.15, 0.85);
    });
    m.Hold(m.Between(0.1, 0.5));
  }
  m.Ease(0.9);
}

/// Hand gestures while talking.
void Talk(Moves& m) {
  for (int i = m.Count(7, 11); i > 0; --i) {
    m.To(m.Between(0.3, 0.7), [&](BodyKey& key) {
      for (size_t s = 0; s < 2; ++s) {
        if (m.Between(0.0, 1.0) < 0.3) continue;
        ReachFor(key, s, {m.Between(0.03, 0.38), m.Between(-0.4, 0.0), m.Between(0.2, 0.38)});
        key.arm[s].pronate = m.Between(-50.0, 50.0);
      }
      key.look = m.Between(-25.0, 25.0);
      key.nod = m.Between(-6.0, 12.0);
      key.turn = m.Between(-10.0, 10.0);
      key.weight = m.Between(0.3, 0.7);
    });
    if (m.Coin()) m.Hold(0.25);
  }
  m.Ease(0.7);
}

/// Both hands swipe, push or steer in front of the body, as in front of a screen.
void Swipe(Moves& m) {
  for (int i = m.Count(3, 5); i > 0; --i) {
    const size_t side = m.Coin() ? 0 : 1;
    const double height_m = m.Between(-0.2, 0.15), from_m = m.Between(0.35, 0.5);
    m.To(0.5, [&](BodyKey& key) { ReachFor(key, side, {from_m, height_m, 0.25}); });
    m.To(m.Between(0.35, 0.6), [&](BodyKey& key) {
      ReachFor(key, side, {m.Between(-0.2, 0.05), height_m + m.Between(-0.1, 0.1), 0.38});
      key.turn = (side == 0 ? -1.0 : 1.0) * 10.0;
    });
    m.To(0.4, [&](BodyKey& key) {  // a push
      ReachFor(key, side, {0.12, height_m, 0.24});
      key.turn = 0.0;
    });
    m.To(0.35, [&](BodyKey& key) { ReachFor(key, side, {0.12, height_m + 0.03, 0.5}); });
    if (m.Coin()) m.Ease(0.6);
  }
  m.Ease(0.7);
}

constexpr std::array<Action, 12> kHandActions = {
    {{"point", Point},
     {"wave", Wave},
     {"clap", Clap},
     {"cross_arms", CrossArms},
     {"roll_hands_up_down", RollHandsUpDown},
     {"roll_hands_forward_backward", RollHandsForwardBackward},
     {"hands_on_hips", HandsOnHips},
     {"hands_to_head", HandsToHead},
     {"raise_arms", RaiseArms},
     {"reach_around", ReachAround},
     {"talk", Talk},
     {"swipe", Swipe}}};

}  // namespace

std::span<const Action> HandActions() { return kHandActions; }

}  // namespace ossa::recon
