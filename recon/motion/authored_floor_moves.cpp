#include "recon/motion/authored_floor_moves_internal.h"

#include <algorithm>
#include <numbers>
#include <string>

#include "recon/body/standard_body.h"
#include "recon/motion/retarget_internal.h"

namespace ossa::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

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

}  // namespace

// Constants: tempo and posture, chosen by hand.

FloorMoves::FloorMoves(uint64_t seed) : random_(seed), tempo_(random_.Uniform(0.8, 1.3)) {
  mirrored_ = random_.Chance(0.5);
  now.body.pitch = Between(-2, 5);
  for (size_t s = 0; s < 2; ++s) now.leg[s].abduct = Between(2, 7);
  Put(0.0);
}

void FloorMoves::To(double seconds, const std::function<void(FloorKey&)>& edit) {
  edit(now);
  Put(seconds * tempo_ * Between(0.9, 1.1));
}

void FloorMoves::Hold(double seconds) {
  To(seconds, [&](FloorKey& key) {  // people are never quite still
    key.body.look += Between(-12, 12);
    key.body.nod += Between(-5, 5);
  });
}

std::vector<RigPose> FloorMoves::Play(double frame_s) const {
  std::vector<RigPose> frames;
  size_t i = 0;
  for (double t = 0.0; t <= times_s_.back(); t += frame_s) {
    while (i + 2 < times_s_.size() && t > times_s_[i + 1]) ++i;
    const double share = std::clamp((t - times_s_[i]) / (times_s_[i + 1] - times_s_[i]), 0.0, 1.0);
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

void FloorMoves::Put(double seconds) {
  times_s_.push_back((times_s_.empty() ? 0.0 : times_s_.back()) + seconds);
  keys_.push_back(ToNumbers(now));
}

}  // namespace ossa::recon
