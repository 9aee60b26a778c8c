// Inverse dynamics against closed forms: a statue, a swinging arm, a lift, a fall, a swaying body.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "depth/base/error.h"
#include "physics/anthropometry.h"
#include "physics/character.h"
#include "recon/orientation.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using recon::Posture;
using test::Lengths;
using test::Moved;
using test::StandingPerson;

constexpr double kGravity_m_s2 = 9.81, kMass_kg = 70.0;
constexpr double kFrame_s = 0.005;  // short: what is left over is the formula's, not the parabola's
constexpr size_t kMiddle = 100;

/// The dynamics in the middle of a motion, from frames of 5 ms and a window of 15.
Dynamics MiddleOf(const std::function<Posture(double)>& posture_at) {
  std::vector<BodyPose> motion;
  for (size_t k = 0; k <= 2 * kMiddle; ++k) {
    const double t = kFrame_s * (static_cast<double>(k) - static_cast<double>(kMiddle));
    const Posture posture = posture_at(t);
    motion.push_back({t, posture, recon::ComputeOrientations(posture)});
  }
  DynamicsOptions options;
  options.mass_kg = kMass_kg;
  options.window_s = 3.0 * kFrame_s;
  return ComputeDynamics(Lengths(), motion, options)[kMiddle];
}

/// The standing person, the left arm straight out to its side, turned by an angle about z.
Posture WithArm(double angle_rad) {
  Posture posture = StandingPerson();
  Vector3d at = posture[Joint::kShoulderLeft];
  for (size_t i = 5; i <= 7; ++i) {
    at += Lengths()[i] * Vector3d(std::cos(angle_rad), std::sin(angle_rad), 0.0);
    posture.position_m[i] = at;
  }
  return posture;
}

/// The straight arm about the shoulder: mass times distance, and transverse moment of inertia.
struct Arm {
  double moment_kgm = 0.0, inertia_kgm2 = 0.0;
};
Arm LeftArm() {
  const Segments segments = ComputeSegments(Lengths(), 0.0, kMass_kg);
  Arm arm;
  double from_m = 0.0;
  for (size_t i = 5; i <= 7; ++i) {
    const double middle_m = from_m + 0.5 * Lengths()[i];
    arm.moment_kgm += segments[i].mass_kg * middle_m;
    arm.inertia_kgm2 +=
        segments[i].mass_kg * middle_m * middle_m + segments[i].transverse_inertia_kgm2;
    from_m += Lengths()[i];
  }
  return arm;
}

TEST(InverseDynamics, StandingStillGivesTheWeight) {
  const Dynamics d = MiddleOf([](double) { return WithArm(0.0); });
  EXPECT_NEAR(d.ground_force_n.y(), kMass_kg * kGravity_m_s2, 1e-6);
  EXPECT_LT(std::hypot(d.ground_force_n.x(), d.ground_force_n.z()), 1e-6);
  ASSERT_TRUE(d.centre_of_pressure_m);
  EXPECT_LT((*d.centre_of_pressure_m - Vector3d(d.centre_of_mass_m.x(), 0, d.centre_of_mass_m.z()))
                .norm(),
            1e-9);
  // The upper arm is held up against its weight and all that hangs on it.
  const Vector3d shoulder = d.torque_nm[Joint::kElbowLeft];
  EXPECT_NEAR(shoulder.z(), LeftArm().moment_kgm * kGravity_m_s2, 1e-6);
  EXPECT_LT((d.foot_force_n[0] + d.foot_force_n[1] - d.ground_force_n).norm(), 1e-9);
  EXPECT_GT(d.foot_force_n[0].y(), d.foot_force_n[1].y());  // it leans to the arm's side
}

TEST(InverseDynamics, HasNoResidualAtTheEndOfTheChain) {
  const Dynamics d = MiddleOf([](double t) { return test::DancingPerson(t); });
  EXPECT_LT(d.torque_nm[Joint::kSpine].norm(), 1e-8);
  EXPECT_LT(d.force_n[Joint::kSpine].norm(), 1e-8);
}

// T = I a + m g r cos(angle), here where the swing turns round.
TEST(InverseDynamics, SwingingArmEqualsAPendulum) {
  constexpr double kTo_rad = 0.6, kRate_rad_s = 6.0;
  const Dynamics d =
      MiddleOf([](double t) { return WithArm(kTo_rad * std::cos(kRate_rad_s * t)); });
  const Arm arm = LeftArm();
  const double expected = -arm.inertia_kgm2 * kTo_rad * kRate_rad_s * kRate_rad_s +
                          arm.moment_kgm * kGravity_m_s2 * std::cos(kTo_rad);
  // The parabola over 15 ms takes w^2 T^2 / 14 off the acceleration: less than a thousandth.
  EXPECT_NEAR(d.torque_nm[Joint::kElbowLeft].z(), expected, 2e-3 * arm.moment_kgm * kGravity_m_s2);
}

TEST(InverseDynamics, AccelerationUpwardsEqualsALargerWeight) {
  const Dynamics still = MiddleOf([](double) { return WithArm(0.3); });
  const Dynamics lifted = MiddleOf([](double t) {
    return Moved(WithArm(0.3), {0.0, 0.5 * 2.0 * t * t, 0.0});
  });
  const double more = (kGravity_m_s2 + 2.0) / kGravity_m_s2;
  EXPECT_NEAR(lifted.ground_force_n.y(), more * kMass_kg * kGravity_m_s2, 1e-4);
  for (size_t i = 2; i < recon::kJointCount; ++i) {
    EXPECT_LT((lifted.torque_nm[i] - more * still.torque_nm[i]).norm(), 1e-4)
        << recon::kJointNames[i];
  }
}

TEST(InverseDynamics, FreeFallNeedsNoForces) {
  const Dynamics d = MiddleOf([](double t) {
    return Moved(StandingPerson(), {0.0, 1.0 - 0.5 * kGravity_m_s2 * t * t, 0.0});
  });
  EXPECT_FALSE(d.centre_of_pressure_m);
  EXPECT_LT(d.ground_force_n.norm(), 1e-4);
  for (const Vector3d& torque : d.torque_nm) EXPECT_LT(torque.norm(), 1e-4);
}

// A body moved as a whole: the centre of pressure is x - h a / g, as under an inverted pendulum.
TEST(InverseDynamics, CentreOfPressureEqualsThatOfAnInvertedPendulum) {
  constexpr double kSwing_m = 0.02, kRate_rad_s = 3.0;
  const Dynamics d = MiddleOf([](double t) {
    return Moved(StandingPerson(), {kSwing_m * std::cos(kRate_rad_s * t), 0.0, 0.0});
  });
  const double acceleration = -kSwing_m * kRate_rad_s * kRate_rad_s;
  ASSERT_TRUE(d.centre_of_pressure_m);
  EXPECT_NEAR(d.centre_of_pressure_m->x(),
              d.centre_of_mass_m.x() - d.centre_of_mass_m.y() * acceleration / kGravity_m_s2, 1e-5);
  EXPECT_NEAR(d.ground_force_n.x(), kMass_kg * acceleration, 0.02);
}

/// The standing person turned as a whole about an axis through the hips.
Posture TurnedAboutHips(const Vector3d& turn_rad) {
  Posture posture = StandingPerson();
  const Vector3d hips = posture[Joint::kHipCenter];
  const Eigen::AngleAxisd turn(turn_rad.norm(), turn_rad.stableNormalized());
  for (Vector3d& p : posture.position_m) p = hips + turn * (p - hips);
  return posture;
}

/// Moment of inertia of the standing person about the hips, kg m^2, about the world's axes.
Eigen::Matrix3d InertiaAboutHips() {
  const Posture posture = StandingPerson();
  const auto turns = recon::ComputeOrientations(posture);
  const Segments segments = ComputeSegments(Lengths(), 0.0, kMass_kg);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    const Segment& s = segments[i];
    const Vector3d r = 0.5 * (posture.position_m[i] + posture.position_m[recon::ParentOf(i)]) -
                       posture[Joint::kHipCenter];
    const Eigen::Matrix3d axes = turns[i].toRotationMatrix();
    const Vector3d own(s.transverse_inertia_kgm2, s.axial_inertia_kgm2, s.transverse_inertia_kgm2);
    sum += axes * own.asDiagonal() * axes.transpose() +
           s.mass_kg * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  return sum;
}

// Euler's equation of a rigid body that turns steadily about a tilted axis in weightlessness: the
// moment w x I w is missing at the end of the chain, the hips.
TEST(InverseDynamics, SteadyTumblingNeedsEulersMoment) {
  const Vector3d rate_rad_s(0.0, 1.5, 2.0);
  std::vector<BodyPose> motion;
  for (int k = -20; k <= 20; ++k) {
    const double t = kFrame_s * k;
    BodyPose pose{t, TurnedAboutHips(t * rate_rad_s), recon::ComputeOrientations(StandingPerson())};
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(t * rate_rad_s.norm(), rate_rad_s.normalized()));
    for (auto& orientation : pose.orientation) orientation = turn * orientation;
    motion.push_back(pose);
  }
  DynamicsOptions options;
  options.mass_kg = kMass_kg;
  options.window_s = 3.0 * kFrame_s;
  options.gravity_m_s2 = 0.0;
  const Vector3d moment = ComputeDynamics(Lengths(), motion, options)[20].torque_nm[Joint::kSpine];
  const Vector3d expected = rate_rad_s.cross(InertiaAboutHips() * rate_rad_s);
  EXPECT_GT(expected.norm(), 1.0);
  EXPECT_LT((moment - expected).norm(), 2e-3 * expected.norm());  // the parabola's error
}

// Turning faster and faster about the vertical: the ground's moment is I times the acceleration.
TEST(InverseDynamics, FreeMomentTurnsTheBody) {
  constexpr double kAcceleration_rad_s2 = 2.0;
  const Dynamics d = MiddleOf([](double t) {
    return TurnedAboutHips({0.0, 0.5 * kAcceleration_rad_s2 * t * t, 0.0});
  });
  const double expected = InertiaAboutHips()(1, 1) * kAcceleration_rad_s2;
  ASSERT_TRUE(d.centre_of_pressure_m);
  EXPECT_NEAR(d.free_moment_nm, expected, 0.02 * expected);  // it acts beside the hips' axis
}

TEST(InverseDynamics, StandingOnOneLegLoadsThatLeg) {
  Posture posture = StandingPerson();
  for (const Joint joint : {Joint::kAnkleLeft, Joint::kFootLeft}) {
    posture[joint] += Vector3d(0.0, 0.3, -0.25);
  }
  const Dynamics d = MiddleOf([&posture](double) { return posture; });
  EXPECT_EQ(d.foot_force_n[0].norm(), 0.0);
  EXPECT_NEAR(d.foot_force_n[1].y(), kMass_kg * kGravity_m_s2, 1e-6);
  // The raised leg hangs on its hip alone: its own weight.
  const Segments segments = ComputeSegments(Lengths(), 0.0, kMass_kg);
  const double leg_kg = segments[13].mass_kg + segments[14].mass_kg + segments[15].mass_kg;
  EXPECT_NEAR(d.force_n[Joint::kKneeLeft].y(), leg_kg * kGravity_m_s2, 1e-6);
}

TEST(InverseDynamics, RefusesInvalidMotion) {
  const Posture posture = StandingPerson();
  std::vector<BodyPose> motion(2, {0.0, posture, recon::ComputeOrientations(posture)});
  motion[1].time_s = 1.0;
  EXPECT_THROW(ComputeDynamics(Lengths(), motion), InputError);
  motion.push_back(motion[1]);
  EXPECT_THROW(ComputeDynamics(Lengths(), motion), InputError);
}

}  // namespace
}  // namespace ossa::physics
