#include <algorithm>

#include "physics/actor_internal.h"
#include "recon/orientation.h"

namespace ossa::physics {

using Eigen::Vector3d;
using recon::Joint;

namespace {

// Constants: by hand, on the scenes of Shum & Ho 2012 section 8.2.
constexpr double kSlow_m_s = 1.5;   // slower objects are carried or rolling
constexpr double kHorizon_s = 0.6;  // a person's warning time

}  // namespace

std::optional<Threat> ThreatTo(const Vector3d& head_m, const Vector3d& head_velocity,
                               const ObjectState& object) {
  constexpr double kNear_m = 0.45;  // passes this near the head's centre
  const Vector3d velocity = object.velocity_m_s - head_velocity;
  const double speed = velocity.norm();
  if (speed < kSlow_m_s) return std::nullopt;
  const Vector3d to_head = head_m - object.position_m;
  const double time = to_head.dot(velocity) / (speed * speed);
  if (time < 0.0 || time > kHorizon_s) return std::nullopt;
  const double distance = (to_head - time * velocity).norm();
  if (distance > kNear_m) return std::nullopt;
  return Threat{time, distance};
}

std::optional<Vector3d> EscapeFrom(const ObjectState& thing, const Vector3d& place_m, double near_m,
                                   const Vector3d& gravity_m_s2) {
  constexpr double kStep_s = 0.02;     // 16 cm of a fast throw
  constexpr double kCentral_m = 0.03;  // nearer to the centre no side is preferred
  if (thing.velocity_m_s.norm() < kSlow_m_s) return std::nullopt;
  Vector3d nearest = Vector3d::Constant(near_m), flight = thing.velocity_m_s;
  bool found = false;
  for (double t = 0.0; t < kHorizon_s; t += kStep_s) {
    const Vector3d velocity = thing.velocity_m_s + t * gravity_m_s2;
    const Vector3d from = place_m - thing.position_m - 0.5 * t * (thing.velocity_m_s + velocity);
    if (from.norm() >= (found ? nearest.norm() : near_m)) continue;
    nearest = from;
    flight = velocity;
    found = true;
  }
  const Vector3d up = -gravity_m_s2.stableNormalized();
  const Vector3d aside = up.cross(flight);  // undefined if it falls vertically
  if (!found || up.isZero()) return std::nullopt;
  Vector3d away = nearest - nearest.dot(up) * up;
  away -= away.dot(flight) / std::max(flight.squaredNorm(), 1e-12) * flight;
  away -= away.dot(up) * up;
  if (away.norm() < kCentral_m) away = aside.norm() > kCentral_m ? aside : up.unitOrthogonal();
  return away.normalized();
}

void LeanBy(const Vector3d& turn_rad, recon::Posture& target) {
  const Eigen::AngleAxisd turn(turn_rad.norm(), turn_rad.stableNormalized());
  const Vector3d hips = target[Joint::kHipCenter];
  constexpr size_t kLast = recon::Index(Joint::kHandRight);  // the following joints are the legs
  for (size_t i = recon::Index(Joint::kSpine); i <= kLast; ++i) {
    target.position_m[i] = hips + turn * (target.position_m[i] - hips);
  }
}

void RaiseForearms(const recon::BoneLengths& lengths, recon::Posture& target) {
  const auto orientation = recon::ComputeOrientations(target);
  const auto& chest = orientation[Joint::kShoulderCenter];
  const Vector3d left = chest * Vector3d::UnitX();
  const Vector3d up = chest * Vector3d::UnitY();
  const Vector3d front = chest * Vector3d::UnitZ();
  const Vector3d head = target[Joint::kHead];
  struct Arm {
    Joint shoulder, elbow, wrist, hand;
    double side;
  };
  constexpr std::array<Arm, 2> kArms = {
      {{Joint::kShoulderLeft, Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft, 1.0},
       {Joint::kShoulderRight, Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight, -1.0}}};
  for (const Arm& arm : kArms) {
    // Upper arm forwards and slightly up; forearm upright beside the face, hands at brow height.
    const Vector3d along = (0.95 * front + 0.25 * up + 0.05 * arm.side * left).normalized();
    target[arm.elbow] = target[arm.shoulder] + lengths[static_cast<size_t>(arm.elbow)] * along;
    const Vector3d brow = head + 0.17 * front + 0.08 * up + 0.06 * arm.side * left;
    const Vector3d forearm = (brow - target[arm.elbow]).normalized();
    target[arm.wrist] = target[arm.elbow] + lengths[static_cast<size_t>(arm.wrist)] * forearm;
    const Vector3d palm = (0.8 * up - 0.5 * arm.side * left - 0.3 * front).normalized();
    target[arm.hand] = target[arm.wrist] + lengths[static_cast<size_t>(arm.hand)] * palm;
  }
}

}  // namespace ossa::physics
