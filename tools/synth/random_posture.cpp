#include "tools/synth/random_posture.h"

#include <algorithm>
#include <numbers>

#include "recon/body/standard_body.h"
#include "tools/synth/pose_bank.h"

namespace ossa::tools {
namespace {

// Constants: limits of joints in degrees, anthropometry (Kapandji 2008), rounded inwards; numbers
// of bones are the rig's.

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr size_t kLowerBack = 11, kSpine = 12, kSpine1 = 13, kNeck = 14, kNeck1 = 15, kHead = 16;

Quaterniond Turn(double degrees, const Vector3d& axis) {
  return Quaterniond(AngleAxisd(degrees * std::numbers::pi / 180.0, axis));
}

/// Bends forwards, to the left, and twists, each by a share of its limit.
Quaterniond Bend(double forwards, double left, double turn, double share) {
  return Turn(share * turn, Vector3d::UnitY()) * Turn(share * forwards, Vector3d::UnitX()) *
         Turn(-share * left, Vector3d::UnitZ());
}

/// Orientation of the pelvis in the world.
Quaterniond DrawPelvis(Random& random) {
  const double kind = random.Unit();
  const double pitch = random.Uniform(-20, 20), roll = random.Uniform(-15, 15);
  const Vector3d x = Vector3d::UnitX(), z = Vector3d::UnitZ();
  if (kind < 0.5) return Turn(pitch, x) * Turn(roll, z);
  if (kind < 0.7) return Turn(random.Uniform(20, 80), x) * Turn(roll, z);  // bent over
  if (kind < 0.8) return Turn(-90 + pitch, x) * Turn(2 * roll, z);         // on the back
  if (kind < 0.9) return Turn(90 + pitch, x) * Turn(2 * roll, z);          // on the belly
  return Turn(2 * pitch, x) * Turn(random.Chance(0.5) ? 85 + roll : -85 + roll, z);
}

void BendTrunk(recon::RigPose* pose, Random& random) {
  auto& r = pose->world_from_rest;
  const double forwards = random.Uniform(-15, 55), left = random.Uniform(-22, 22);
  const double turn = random.Uniform(-35, 35);
  r[kLowerBack] = r[0] * Bend(forwards, left, turn, 0.3);
  r[kSpine] = r[kLowerBack] * Bend(forwards, left, turn, 0.35);
  r[kSpine1] = r[kSpine] * Bend(forwards, left, turn, 0.35);
  const double nod = random.Uniform(-35, 35), tilt = random.Uniform(-25, 25);
  const double look = random.Uniform(-60, 60);
  r[kNeck] = r[kSpine1] * Bend(nod, tilt, look, 0.3);
  r[kNeck1] = r[kNeck] * Bend(nod, tilt, look, 0.3);
  r[kHead] = r[kNeck1] * Bend(nod, tilt, look, 0.4);
}

void RandomLeg(size_t side, recon::RigPose* pose, Random& random) {
  constexpr size_t kFirst[2] = {1, 6};  // hip, thigh, shin, foot, toes follow each other
  const double sign = side == 0 ? 1.0 : -1.0;
  const double flex = random.Uniform(-15, 115), abduct = random.Uniform(-12, 40);
  // Only a bent hip can rotate far.
  const double turn = random.Uniform(-15, 45) * (flex > 40 ? 1.0 : 0.5);
  const double knee = random.Chance(0.3) ? random.Uniform(0, 15) : random.Uniform(0, 138);
  const double foot = random.Uniform(-15, 40);
  auto& r = pose->world_from_rest;
  const size_t hip = kFirst[side];
  r[hip] = r[0];
  r[hip + 1] = r[0] * Turn(sign * turn, Vector3d::UnitY()) *
               Turn(sign * abduct, Vector3d::UnitZ()) * Turn(-flex, Vector3d::UnitX());
  r[hip + 2] = r[hip + 1] * Turn(knee, Vector3d::UnitX());
  r[hip + 3] = r[hip + 4] = r[hip + 2] * Turn(foot, Vector3d::UnitX());
}

/// Puts the lowest joint above the floor by the thickness of its flesh.
void StandOnFloor(recon::RigPose* pose) {
  constexpr double kFlesh_m = 0.06;
  const recon::Posture posture = recon::StandardPosture(*pose);
  double lowest_m = posture.position_m[0].y();
  for (const auto& joint_m : posture.position_m) lowest_m = std::min(lowest_m, joint_m.y());
  pose->root_m.y() += kFlesh_m - lowest_m;
}

}  // namespace

recon::RigPose RandomPosture(Random& random) {
  recon::RigPose pose;
  pose.root_m = recon::StandardRigRest().head_m[0];
  pose.root_m.x() = pose.root_m.z() = 0.0;
  pose.world_from_rest[0] = DrawPelvis(random);
  BendTrunk(&pose, random);
  for (size_t side = 0; side < 2; ++side) {
    RandomLeg(side, &pose, random);
    RandomArm(side, &pose, random);
  }
  StandOnFloor(&pose);
  return pose;
}

}  // namespace ossa::tools
