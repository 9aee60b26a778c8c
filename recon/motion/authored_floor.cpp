#include "recon/motion/authored_floor.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "recon/motion/authored_clip_internal.h"
#include "recon/motion/authored_floor_moves_internal.h"

namespace ossa::recon {
namespace {

// Constants: postures in degrees and seconds, chosen by hand.

void Relax(FloorMoves& m, FloorKey& key) {  // arms in a relaxed position
  for (ArmKey& arm : key.body.arm) {
    arm = {m.Between(-10, 40), m.Between(8, 60), m.Between(0.7, 0.97), m.Between(-15, 30),
           m.Between(-10, 60)};
  }
}

void Crouched(FloorMoves& m, FloorKey& key) {
  key.body.pitch = m.Between(5, 35);
  key.body.bend = m.Between(10, 35);
  key.body.roll = key.body.side = 0.0;
  key.body.nod = m.Between(-30, 5);
  for (LegAngles& leg : key.leg) {
    leg = {m.Between(95, 125), m.Between(-5, 5), m.Between(5, 30), m.Between(115, 140),
           m.Between(-20, 15)};
  }
}

void Crouch(FloorMoves& m) {
  m.To(0.9, [&](FloorKey& key) {
    Crouched(m, key);
    for (size_t s = 0; s < 2; ++s) {
      ReachFor(key.body, s, {m.Between(0.02, 0.3), m.Between(-0.5, -0.1), m.Between(0.15, 0.45)});
    }
  });
  for (int i = 0; i < 3; ++i) {
    m.To(0.7, [&](FloorKey& key) {
      key.body.turn = m.Between(-30, 30);
      const size_t s = m.Coin() ? 0 : 1;
      ReachFor(key.body, s, {m.Between(0.0, 0.4), m.Between(-0.55, 0.1), m.Between(0.2, 0.5)});
    });
  }
}

void Kneeling(FloorMoves& m, FloorKey& key, bool one_knee) {
  key.body.pitch = m.Between(-5, 20);
  key.body.bend = m.Between(-5, 25);
  key.body.roll = key.body.side = 0.0;
  const double sitting = m.Coin() ? m.Between(60, 95) : m.Between(0, 25);  // on the heels, or tall
  for (LegAngles& leg : key.leg) {
    leg = {sitting + key.body.pitch, m.Between(2, 10), 0.0, std::min(140.0, 88.0 + 0.6 * sitting),
           m.Between(35, 60)};
  }
  if (one_knee) key.leg[0] = {m.Between(80, 100), 0.0, m.Between(0, 20), m.Between(75, 105), 0.0};
}

void Kneel(FloorMoves& m) {
  m.To(0.8, [&](FloorKey& key) { Kneeling(m, key, true); });
  for (int i = 0; i < 3; ++i) {
    m.To(0.8, [&](FloorKey& key) {
      Kneeling(m, key, m.Coin());
      Relax(m, key);
    });
    m.Hold(0.4);
  }
}

void SittingOnFloor(FloorMoves& m, FloorKey& key) {
  key.body.pitch = m.Between(-35, 5);
  key.body.bend = m.Between(5, 40);
  key.body.roll = key.body.side = 0.0;
  key.body.nod = m.Between(-20, 15);
  const double kind = m.Between(0, 3);
  for (LegAngles& leg : key.leg) {
    if (kind < 1) {  // cross-legged
      leg = {m.Between(75, 95), m.Between(-75, -55), m.Between(40, 55), m.Between(110, 135), 20.0};
    } else if (kind < 2) {  // knees up
      leg = {m.Between(95, 125), m.Between(-5, 5), m.Between(0, 20), m.Between(85, 135), 10.0};
    } else {  // legs out
      leg = {m.Between(70, 90), 0.0, m.Between(0, 30), m.Between(0, 40), m.Between(0, 35)};
    }
    leg.flex += key.body.pitch;
  }
}

void SitOnFloor(FloorMoves& m) {
  m.To(0.9, [&](FloorKey& key) { Crouched(m, key); });
  for (int i = 0; i < 3; ++i) {
    m.To(0.9, [&](FloorKey& key) {
      SittingOnFloor(m, key);
      Relax(m, key);
      if (!m.Coin()) return;
      for (size_t s = 0; s < 2; ++s) {  // props itself up behind, or holds its knees
        const double before_m = m.Coin() ? m.Between(-0.3, -0.1) : m.Between(0.3, 0.45);
        ReachFor(key.body, s, {m.Between(0.05, 0.3), m.Between(-0.5, -0.3), before_m});
      }
    });
    m.Hold(0.4);
  }
}

void Lying(FloorMoves& m, FloorKey& key, double kind) {
  key.body.bend = m.Between(-8, 15);
  key.body.turn = m.Between(-15, 15);
  key.body.nod = m.Between(-15, 20);
  const bool on_side = kind >= 2;
  key.body.pitch = on_side    ? m.Between(-20, 20)
                   : kind < 1 ? m.Between(-95, -85)
                              : m.Between(82, 95);
  key.body.roll = on_side ? m.Between(75, 95) : m.Between(-6, 6);
  for (LegAngles& leg : key.leg) {
    leg = {kind < 1  ? m.Between(-2, 60)
           : on_side ? m.Between(5, 80)
                     : m.Between(-8, 5),
           m.Between(0, 18), m.Between(0, 20), m.Between(0, 30), m.Between(10, 40)};
    if (kind < 1) leg.knee += leg.flex;  // the foot is on the floor
    if (on_side) leg.knee = m.Between(10, 110);
  }
}

void Lie(FloorMoves& m) {
  m.To(0.9, [&](FloorKey& key) { Crouched(m, key); });
  m.To(0.8, [&](FloorKey& key) { SittingOnFloor(m, key); });
  for (int i = 0; i < 4; ++i) {
    m.To(1.0, [&](FloorKey& key) {
      Lying(m, key, m.Between(0, 3));
      for (ArmKey& arm : key.body.arm) {
        arm = {m.Between(-15, 120), m.Between(5, 110), m.Between(0.45, 0.98), m.Between(-20, 40),
               m.Between(-30, 80)};
      }
    });
    m.Hold(0.5);
  }
}

void Fall(FloorMoves& m) {
  m.Hold(0.3);
  m.To(0.35, [&](FloorKey& key) {
    Crouched(m, key);
    Relax(m, key);
    key.body.roll = m.Between(-30, 50);
  });
  m.To(0.35, [&](FloorKey& key) { Lying(m, key, m.Between(0, 3)); });
  m.Hold(1.0);
}

void Crawl(FloorMoves& m) {
  const double trunk = m.Between(75, 95), hand_m = m.Between(0.42, 0.52);
  m.To(0.9, [&](FloorKey& key) { Kneeling(m, key, false); });
  for (int i = 0; i < 5; ++i) {
    m.To(0.6, [&](FloorKey& key) {
      key.body.pitch = trunk;
      key.body.bend = m.Between(-8, 8);
      key.body.nod = m.Between(-45, -5);
      const double stride = i % 2 == 0 ? 18 : -18;
      for (size_t s = 0; s < 2; ++s) {
        const double ahead = s == 0 ? stride : -stride;
        key.leg[s] = {90 + ahead, m.Between(0, 8), 0.0, 90.0 + ahead / 2, 45.0};
        ReachFor(key.body, s, {m.Between(0.12, 0.25), -0.1 + ahead / 150, hand_m});
      }
    });
  }
}

void HandToHead(FloorMoves& m, FloorKey& key, size_t s) {
  ReachFor(key.body, s, {m.Between(0.1, 0.16), m.Between(0.12, 0.22), m.Between(-0.05, 0.06)});
  key.body.arm[s].swivel = m.Between(-30, 10);
}

void ElbowToKnee(FloorMoves& m) {
  const bool lying = m.Coin();
  if (lying) m.To(1.0, [&](FloorKey& key) { Lying(m, key, 0.0); });
  m.To(0.7, [&](FloorKey& key) {
    for (size_t s = 0; s < 2; ++s) HandToHead(m, key, s);
  });
  for (int i = 0; i < 4; ++i) {
    const FloorKey before = m.now;
    const size_t knee = i % 2 == 0 ? 0 : 1;
    m.To(0.6, [&](FloorKey& key) {
      key.leg[knee] = {m.Between(95, 120), m.Between(-10, 5), m.Between(-15, 5), m.Between(80, 115),
                       10.0};
      key.body.bend = m.Between(25, 45);
      key.body.turn = (knee == 0 ? 1.0 : -1.0) * m.Between(20, 38);
      key.body.arm[1 - knee].flex += m.Between(-25, 5);
    });
    m.To(0.6, [&](FloorKey& key) { key = before; });
  }
}

void ArmsBehind(FloorMoves& m) {
  for (int i = 0; i < 3; ++i) {
    m.To(0.8, [&](FloorKey& key) {
      key.body.bend = m.Between(-8, 12);
      key.body.look = m.Between(-40, 40);
      for (size_t s = 0; s < 2; ++s) {
        if (m.Coin() && m.Coin()) continue;
        ReachFor(key.body, s,
                 {m.Between(-0.12, 0.12), m.Between(-0.5, -0.25), m.Between(-0.2, -0.1)});
        key.body.arm[s].swivel = m.Between(0, 40);
      }
    });
    m.Hold(0.5);
    if (m.Coin()) m.To(0.6, [&](FloorKey& key) { Relax(m, key); });
  }
}

void TurnFast(FloorMoves& m) {
  for (int i = 0; i < 4; ++i) {
    const double turn = (m.Coin() ? 1.0 : -1.0) * m.Between(120, 330);
    m.To(m.Between(0.35, 0.7), [&](FloorKey& key) {
      key.body.heading += turn;
      key.body.turn = 0.1 * turn;
      key.body.look = 0.12 * turn;
      Relax(m, key);
      key.leg[0].flex = m.Between(0, 30);
      key.leg[0].knee = key.leg[0].flex + m.Between(0, 15);
    });
    m.To(0.4, [&](FloorKey& key) {
      key.body.turn = key.body.look = key.leg[0].flex = key.leg[0].knee = 0;
    });
  }
}

struct FloorAction {
  std::string_view name;
  void (*perform)(FloorMoves&);
};
constexpr std::array<FloorAction, 9> kFloorActions = {{{"crouch", Crouch},
                                                       {"kneel", Kneel},
                                                       {"sit_on_floor", SitOnFloor},
                                                       {"lie", Lie},
                                                       {"fall", Fall},
                                                       {"crawl", Crawl},
                                                       {"elbow_to_knee", ElbowToKnee},
                                                       {"arms_behind", ArmsBehind},
                                                       {"turn_fast", TurnFast}}};

}  // namespace

std::vector<std::string> AuthoredFloorActions() {
  std::vector<std::string> names;
  for (const FloorAction& action : kFloorActions) names.emplace_back(action.name);
  return names;
}

std::vector<MotionClip> AuthoredFloorClips(const AuthoredOptions& options) {
  return PlayActions<FloorMoves>(
      "authored-floor", kFloorActions, options,
      [&](uint64_t action, uint64_t v) { return MixSeed(options.seed, action, v); });
}

}  // namespace ossa::recon
