// Inverse dynamics: forces and torques from motion (Winter 2009, chs. 5 and 7; Newton-Euler
// equations, segment by segment from hands, head and feet inwards).
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "depth/base/error.h"
#include "physics/anthropometry.h"
#include "physics/character.h"
#include "recon/smallest_turn.h"

namespace ossa::physics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector4d;
using recon::Joint;
using recon::kJointCount;

/// The motion of one bone at one time: its middle, which is its centre of mass.
struct BoneMotion {
  Vector3d middle_m, acceleration_m_s2;
  Vector3d angular_momentum_rate_nm;  // about the middle
};
using BodyMotion = recon::JointArray<BoneMotion>;

/// Value, first and second derivative at 0 of the least-squares parabola through samples at times
/// t.
struct Parabola {
  Vector3d value, rate, acceleration;
};

Parabola FitParabola(const std::vector<double>& t, const std::vector<Vector3d>& samples) {
  Eigen::MatrixXd powers(static_cast<Eigen::Index>(t.size()), 3);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(t.size()), 3);
  for (size_t k = 0; k < t.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(k);
    powers.row(row) << 1.0, t[k], t[k] * t[k];
    values.row(row) = samples[k].transpose();
  }
  const Eigen::Matrix3d c = powers.colPivHouseholderQr().solve(values);
  return {c.row(0).transpose(), c.row(1).transpose(), 2.0 * c.row(2).transpose()};
}

/// The frames used for derivatives at `frame`: all within the window, at least three.
struct Window {
  size_t from, to;  // one past the last
};

Window WindowAround(std::span<const BodyPose> motion, size_t frame, double window_s) {
  Window w = {frame, frame + 1};
  const double t = motion[frame].time_s;
  while (w.from > 0 && t - motion[w.from - 1].time_s <= window_s + 1e-9) --w.from;
  while (w.to < motion.size() && motion[w.to].time_s - t <= window_s + 1e-9) ++w.to;
  if (w.to - w.from < 3 && w.from > 0) --w.from;
  if (w.to - w.from < 3 && w.to < motion.size()) ++w.to;
  if (w.to - w.from < 3 && w.from > 0) --w.from;
  if (w.to - w.from < 3 && w.to < motion.size()) ++w.to;
  return w;
}

BodyMotion MotionAt(std::span<const BodyPose> motion, size_t frame, const Segments& segments,
                    double window_s) {
  const Window window = WindowAround(motion, frame, window_s);
  std::vector<double> t;
  for (size_t k = window.from; k < window.to; ++k) {
    t.push_back(motion[k].time_s - motion[frame].time_s);
  }
  BodyMotion body;
  for (size_t i = 1; i < kJointCount; ++i) {
    const Eigen::Quaterniond now = motion[frame].orientation[i];
    std::vector<Vector3d> middles, turns;
    for (size_t k = window.from; k < window.to; ++k) {
      const auto& p = motion[k].posture.position_m;
      middles.emplace_back(0.5 * (p[i] + p[recon::ParentOf(i)]));
      turns.push_back(recon::ToRotationVector(motion[k].orientation[i] * now.conjugate()));
    }
    // At zero rotation the derivatives of the rotation vector are angular velocity and
    // acceleration.
    const Parabola place = FitParabola(t, middles), turn = FitParabola(t, turns);
    const Segment& s = segments[i];
    const Matrix3d axes = now.toRotationMatrix();
    const Matrix3d inertia =
        axes *
        Vector3d(s.transverse_inertia_kgm2, s.axial_inertia_kgm2, s.transverse_inertia_kgm2)
            .asDiagonal() *
        axes.transpose();
    body[i] = {middles[frame - window.from], place.acceleration,
               inertia * turn.acceleration + turn.rate.cross(inertia * turn.rate)};
  }
  return body;
}

/// A force with its point of application, and a moment.
struct Wrench {
  Vector3d force_n = Vector3d::Zero(), moment_nm = Vector3d::Zero(), at_m = Vector3d::Zero();
};

Vector3d OntoFloor(const Vector4d& floor, const Vector3d& p) {
  return p - (floor.head<3>().dot(p) + floor[3]) * floor.head<3>();
}

/// The total ground reaction needed for the body's motion.
Wrench GroundWrench(const BodyMotion& body, const Segments& segments, const Vector3d& gravity,
                    const Vector4d& floor, Dynamics& result) {
  Wrench ground;
  double mass_kg = 0.0;
  result.centre_of_mass_m.setZero();
  for (size_t i = 1; i < kJointCount; ++i) {
    mass_kg += segments[i].mass_kg;
    result.centre_of_mass_m += segments[i].mass_kg * body[i].middle_m;
  }
  result.centre_of_mass_m /= mass_kg;
  ground.at_m = OntoFloor(floor, result.centre_of_mass_m);
  for (size_t i = 1; i < kJointCount; ++i) {
    const Vector3d force = segments[i].mass_kg * (body[i].acceleration_m_s2 - gravity);
    ground.force_n += force;
    ground.moment_nm +=
        body[i].angular_momentum_rate_nm + (body[i].middle_m - ground.at_m).cross(force);
  }
  // By hand: below a twentieth of the weight the body is airborne
  constexpr double kAirborne = 0.05;
  const Vector3d up = floor.head<3>();
  const double pressing = ground.force_n.dot(up);
  if (pressing < kAirborne * mass_kg * gravity.norm() || gravity.isZero()) return ground;
  // The centre of pressure: only a moment about the floor's normal remains.
  const Vector3d aside = up.cross(ground.moment_nm) / pressing;
  ground.at_m += aside;
  ground.moment_nm = (ground.moment_nm - aside.cross(ground.force_n)).dot(up) * up;
  result.centre_of_pressure_m = ground.at_m;
  return ground;
}

/// The floor points below the middle of each foot.
std::array<Vector3d, 2> FeetOnFloor(const recon::Posture& posture, const Vector4d& floor) {
  return {OntoFloor(floor, 0.5 * (posture[Joint::kFootLeft] + posture[Joint::kAnkleLeft])),
          OntoFloor(floor, 0.5 * (posture[Joint::kFootRight] + posture[Joint::kAnkleRight]))};
}

/// The right foot's share of the ground reaction: 0 for a foot off the floor; between two standing
/// feet it follows from the position of the centre of pressure.
double RightShare(const recon::Posture& posture, const Vector4d& floor, const Vector3d& pressure_m,
                  double sole_m) {
  constexpr double kStands_m = 0.05;  // by hand: of a foot joint above the sole
  const auto height = [&](Joint toe) { return floor.dot(posture[toe].homogeneous()) - sole_m; };
  const double left_m = height(Joint::kFootLeft), right_m = height(Joint::kFootRight);
  if (left_m > kStands_m || right_m > kStands_m) return right_m < left_m ? 1.0 : 0.0;
  const auto [left, right] = FeetOnFloor(posture, floor);
  const Vector3d way = right - left;
  return std::clamp((pressure_m - left).dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
}

/// Ground reaction of each foot. The moments of two feet about the centre of pressure cancel.
std::array<Wrench, 2> ShareOut(const Wrench& ground, const recon::Posture& posture,
                               const Vector4d& floor, double sole_m) {
  const double right = RightShare(posture, floor, ground.at_m, sole_m);
  const auto [left_m, right_m] = FeetOnFloor(posture, floor);
  const bool both = right > 0.0 && right < 1.0;
  const Vector3d way = both ? Vector3d(right_m - left_m) : Vector3d(Vector3d::Zero());
  return {
      Wrench{(1.0 - right) * ground.force_n, (1.0 - right) * ground.moment_nm,
             ground.at_m - right * way},
      Wrench{right * ground.force_n, right * ground.moment_nm, ground.at_m + (1.0 - right) * way}};
}

/// From the extremities inwards: force and torque at the start of each bone.
void SolveJoints(const BodyMotion& body, const recon::Posture& posture, const Segments& segments,
                 const Vector3d& gravity, const std::array<Wrench, 2>& feet, Dynamics& result) {
  result.force_n.fill(Vector3d::Zero());
  result.torque_nm.fill(Vector3d::Zero());
  for (size_t i = kJointCount - 1; i > 0; --i) {
    const Vector3d& joint = posture.position_m[recon::ParentOf(i)];
    const Vector3d own = segments[i].mass_kg * (body[i].acceleration_m_s2 - gravity);
    result.force_n[i] += own;
    result.torque_nm[i] += body[i].angular_momentum_rate_nm + (body[i].middle_m - joint).cross(own);
    for (size_t k = 0; k < 2; ++k) {
      if (i != recon::Index(k == 0 ? Joint::kFootLeft : Joint::kFootRight)) continue;
      result.force_n[i] -= feet[k].force_n;
      result.torque_nm[i] -= feet[k].moment_nm + (feet[k].at_m - joint).cross(feet[k].force_n);
    }
    const size_t before = recon::ParentOf(i) == 0 ? 1 : recon::ParentOf(i);
    if (i == 1) break;
    const Vector3d& its_joint = posture.position_m[recon::ParentOf(before)];
    result.force_n[before] += result.force_n[i];
    result.torque_nm[before] += result.torque_nm[i] + (joint - its_joint).cross(result.force_n[i]);
  }
}

void CheckMotion(const recon::BoneLengths& lengths, std::span<const BodyPose> motion,
                 const DynamicsOptions& options) {
  if (motion.size() < 3) {
    throw InputError("inverse dynamics: expected 3 frames or more, found " +
                     std::to_string(motion.size()));
  }
  for (size_t k = 1; k < motion.size(); ++k) {
    if (motion[k].time_s > motion[k - 1].time_s) continue;
    throw InputError("inverse dynamics: frame " + std::to_string(k) +
                     ": expected a time after the frame before, found " +
                     std::to_string(motion[k].time_s) + " s");
  }
  for (size_t i = 1; i < kJointCount; ++i) {
    if (lengths[i] > 0.0 && lengths[i] <= 2.0) continue;
    throw InputError("inverse dynamics: length of the bone to " +
                     std::string(recon::kJointNames[i]) + " must be in (0, 2] m");
  }
  if (!(options.window_s >= 0.0 && options.window_s <= 1.0)) {
    throw std::invalid_argument("window_s = " + std::to_string(options.window_s) +
                                ", must be in [0, 1]");
  }
}

}  // namespace

std::vector<Dynamics> ComputeDynamics(const recon::BoneLengths& lengths,
                                      std::span<const BodyPose> motion,
                                      const DynamicsOptions& options) {
  CheckMotion(lengths, motion, options);
  const Segments segments = ComputeSegments(lengths, options.stature_m, options.mass_kg);
  const Vector4d floor = options.floor / options.floor.head<3>().norm();
  const Vector3d gravity = -options.gravity_m_s2 * floor.head<3>();
  std::vector<Dynamics> results;
  for (size_t frame = 0; frame < motion.size(); ++frame) {
    const recon::Posture& posture = motion[frame].posture;
    const BodyMotion body = MotionAt(motion, frame, segments, options.window_s);
    Dynamics result;
    const Wrench ground = GroundWrench(body, segments, gravity, floor, result);
    result.ground_force_n = ground.force_n;
    std::array<Wrench, 2> feet;
    if (result.centre_of_pressure_m) {
      feet = ShareOut(ground, posture, floor, segments[recon::Index(Joint::kFootLeft)].radius_m);
      result.free_moment_nm = ground.moment_nm.dot(floor.head<3>());
    }
    for (size_t k = 0; k < 2; ++k) result.foot_force_n[k] = feet[k].force_n;
    SolveJoints(body, posture, segments, gravity, feet, result);
    results.push_back(result);
  }
  return results;
}

}  // namespace ossa::physics
