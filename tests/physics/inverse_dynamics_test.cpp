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
