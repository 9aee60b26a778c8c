#include "recon/motion/authored_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>

#include "depth/base/random.h"
#include "recon/body/standard_body.h"
#include "recon/motion/authored_body_internal.h"
#include "recon/motion/authored_clip_internal.h"
#include "recon/motion/retarget_internal.h"

namespace ossa::recon {
namespace {

// Constants: postures in degrees and seconds, chosen by hand.

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

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

constexpr size_t kFloorNumbers = kBodyKeyNumbers + 10;
using FloorNumbers = std::array<double, kFloorNumbers>;

FloorNumbers ToNumbers(const FloorKey& key) {
  FloorNumbers numbers{};
  const BodyKeyNumbers body = recon::ToNumbers(key.body);
  std::copy(body.begin(), body.end(), numbers.begin());
  size_t i = kBodyKeyNumbers;
  for (const LegAngles& l : key.leg) {
    for (const double v : {l.flex, l.abduct, l.turn, l.knee, l.foot}) numbers[i++] = v;
  }
  return numbers;
}

FloorKey ToKey(const FloorNumbers& numbers) {
  FloorKey key;
  BodyKeyNumbers body{};
  std::copy_n(numbers.begin(), kBodyKeyNumbers, body.begin());
  key.body = recon::ToKey(body);
  size_t i = kBodyKeyNumbers;
  for (LegAngles& l : key.leg) {
    l = {numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3], numbers[i + 4]};
    i += 5;
  }
  return key;
}

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

void PoseLeg(const LegAngles& leg, size_t side, RigPose& pose) {
  const double sign = side == 0 ? 1.0 : -1.0;
  const std::string name = side == 0 ? "Left" : "Right";
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  auto& r = pose.world_from_rest;
  r[RigBone(side == 0 ? "LHipJoint" : "RHipJoint")] = r[0];
  const Quaterniond thigh =
      r[0] * Turn(sign * leg.turn, y) * Turn(sign * leg.abduct, z) * Turn(-leg.flex, x);
  const Quaterniond shin = thigh * Turn(leg.knee, x);
  r[RigBone(name + "UpLeg")] = thigh;
  r[RigBone(name + "Leg")] = shin;
  r[RigBone(name + "Foot")] = r[RigBone(name + "ToeBase")] = shin * Turn(leg.foot, x);
}

/// Puts the lowest part of the body on the floor.
void LayDown(RigPose& pose) {
  // Distance from each joint to the skin, metres, anthropometry, rounded; in SDK order.
  constexpr JointArray<double> kFlesh_m = {0.11, 0.11, 0.08, 0.11, 0.07, 0.05, 0.04,
                                           0.03, 0.07, 0.05, 0.04, 0.03, 0.10, 0.06,
                                           0.06, 0.03, 0.10, 0.06, 0.06, 0.03};
  const Posture posture = StandardPosture(pose);
  double lowest_m = posture.position_m[0].y();
  for (size_t j = 0; j < kJointCount; ++j) {
    lowest_m = std::min(lowest_m, posture.position_m[j].y() - kFlesh_m[j]);
  }
  pose.root_m.y() -= lowest_m;
}

RigPose ComputePose(const FloorKey& key) {
  RigPose pose;
  pose.root_m = key.body.pelvis_m;
  PoseTrunk(key.body, pose);
  for (size_t s = 0; s < 2; ++s) {
    PoseArm(key.body.arm[s], s, pose);
    PoseLeg(key.leg[s], s, pose);
  }
  FollowArmsWithCollars(pose);
  LayDown(pose);
  return pose;
}

/// A sequence of timed keys under construction, interpolated with easing.
class FloorMoves {
 public:
  explicit FloorMoves(uint64_t seed) : random_(seed), tempo_(random_.Uniform(0.8, 1.3)) {
    mirrored_ = random_.Chance(0.5);
    now.body.pitch = Between(-2, 5);
    for (size_t s = 0; s < 2; ++s) now.leg[s].abduct = Between(2, 7);
    Put(0.0);
  }

  FloorKey now;

  void To(double seconds, const std::function<void(FloorKey&)>& edit) {
    edit(now);
    Put(seconds * tempo_ * Between(0.9, 1.1));
  }
  void Hold(double seconds) {
    To(seconds, [&](FloorKey& key) {  // people are never quite still
      key.body.look += Between(-12, 12);
      key.body.nod += Between(-5, 5);
    });
  }
  double Between(double low, double high) { return random_.Uniform(low, high); }
  bool Coin() { return random_.Chance(0.5); }

  std::vector<RigPose> Play(double frame_s) const {
    std::vector<RigPose> frames;
    size_t i = 0;
    for (double t = 0.0; t <= times_s_.back(); t += frame_s) {
      while (i + 2 < times_s_.size() && t > times_s_[i + 1]) ++i;
      const double share =
          std::clamp((t - times_s_[i]) / (times_s_[i + 1] - times_s_[i]), 0.0, 1.0);
      const double eased = share * share * (3.0 - 2.0 * share);
      FloorNumbers numbers = keys_[i];
      for (size_t n = 0; n < numbers.size(); ++n) {
        numbers[n] += eased * (keys_[i + 1][n] - numbers[n]);
      }
      FloorKey key = ToKey(numbers);
      if (mirrored_) {
        key.body = Mirrored(key.body);
        std::swap(key.leg[0], key.leg[1]);
      }
      frames.push_back(ComputePose(key));
    }
    return frames;
  }

 private:
  void Put(double seconds) {
    times_s_.push_back((times_s_.empty() ? 0.0 : times_s_.back()) + seconds);
    keys_.push_back(ToNumbers(now));
  }

  Random random_;
  double tempo_;
  bool mirrored_ = false;
  std::vector<double> times_s_;
  std::vector<FloorNumbers> keys_;
};

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
constexpr std::array<FloorAction, 9> kActions = {{{"crouch", Crouch},
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
  for (const FloorAction& action : kActions) names.emplace_back(action.name);
  return names;
}

std::vector<MotionClip> AuthoredFloorClips(const AuthoredOptions& options) {
  return PlayActions<FloorMoves>(
      "authored-floor", kActions, options,
      [&](uint64_t action, uint64_t v) { return MixSeed(options.seed, action, v); });
}

}  // namespace ossa::recon
