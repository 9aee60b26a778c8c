// The world against closed-form mechanics.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/anthropometry.h"
#include "physics/world.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using test::kFrame_s;
using test::Lengths;
using test::Moved;
using test::StandingPerson;

CharacterOptions Free() {
  CharacterOptions options;
  options.pin_feet = false;
  options.self_collision = false;
  return options;
}

TEST(Mechanics, UncontrolledCharacterFallsFreely) {
  World world;
  const int person = world.AddCharacter(Lengths(), StandingPerson(), Free());
  world.StopControl(person);
  for (int i = 0; i < 15; ++i) world.Step(kFrame_s);
  const double t = 0.5, h = kFrame_s / 10;
  const double fallen = StandingPerson()[recon::Joint::kHipCenter].y() -
                        world.StateOf(person).posture[recon::Joint::kHipCenter].y();
  // Semi-implicit Euler falls g t h / 2 further than g t^2 / 2.
  EXPECT_NEAR(fallen, 0.5 * 9.81 * t * t + 0.5 * 9.81 * t * h, 1e-4);
}

TEST(Mechanics, PendulumHasItsPeriod) {
  World world;
  ObjectOptions bob;
  bob.shape = Shape::kBall;
  bob.size_m = Vector3d::Constant(0.1);
  const double length = 1.0, angle = 0.1;
  bob.position_m = {length * std::sin(angle), -length * std::cos(angle), 0.0};
  const int ball = world.AddObject(bob);
  world.Hang(ball, Vector3d::Zero());
  // Time between the first and the eleventh downward crossing, interpolated: ten periods.
  double first = -1.0, last = 0.0, before = bob.position_m.x();
  int crossings = 0;
  for (int i = 1; crossings < 11; ++i) {
    world.Step(kFrame_s);
    const double x = world.ObjectOf(ball).position_m.x();
    if (before > 0.0 && x <= 0.0) {
      last = (i - x / (x - before)) * kFrame_s;
      if (++crossings == 1) first = last;
    }
    before = x;
    ASSERT_LT(i, 2000);
  }
  // Physical pendulum: ball's own inertia 2/5 m r^2, amplitude correction 1 + a^2/16.
  const double inertia = length * length + 0.4 * 0.05 * 0.05;
  const double period = 2 * M_PI * std::sqrt(inertia / (9.81 * length)) * (1 + angle * angle / 16);
  EXPECT_NEAR((last - first) / 10, period, 0.003 * period);  // air damping, interpolation
}

TEST(Mechanics, StepResponseIsAsDerived) {
  WorldOptions fine;
  fine.substeps = 100;
  World world(fine);
  CharacterOptions options = Free();
  options.gains.rate_rad_s = 30.0;
  options.lead = 0.0;
  const int person = world.AddCharacter(Lengths(), StandingPerson(), options);
  const double jump = 0.1;  // w^2 jump stays below the bound on accelerations
  const double x0 = world.StateOf(person).posture.position_m[0].x();
  world.SetTarget(person, Moved(StandingPerson(), {jump, 0.0, 0.0}));
  for (int i = 1; i <= 10; ++i) {
    world.Step(0.01);
    const double wt = 30.0 * i * 0.01;
    const double wanted = jump * (1.0 - (1.0 + wt) * std::exp(-wt));
    const auto posture = world.StateOf(person).posture;
    // All joints move alike, no joint pulls on another. Tolerance: first order in the step.
    for (const size_t joint : {0U, 3U, 7U, 19U}) {
      EXPECT_NEAR(posture.position_m[joint].x() - StandingPerson().position_m[joint].x() - x0,
                  wanted, 0.002)
          << joint;
    }
  }
}

TEST(Mechanics, ImpulseAddsToTheMomentum) {
  WorldOptions weightless;
  weightless.gravity_m_s2 = 0.0;
  World world(weightless);
  const int person = world.AddCharacter(Lengths(), StandingPerson(), Free());
  world.StopControl(person);
  const Vector3d impulse(10.0, -3.0, 5.0);
  world.ApplyImpulse(person, recon::Joint::kShoulderLeft, impulse);
  for (int i = 0; i < 10; ++i) world.Step(kFrame_s);
  // Joint forces come in opposite pairs, so no solver error can change the sum.
  EXPECT_LT((world.StateOf(person).momentum_kg_m_s - impulse).norm(), 1e-6);
}

TEST(Mechanics, PushedCharacterReturns) {
  World world;
  world.SetFloor(test::Ground());
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  world.SetTarget(person, StandingPerson());
  for (int i = 0; i < 20; ++i) world.Step(kFrame_s);
  world.ApplyImpulse(person, recon::Joint::kShoulderCenter, {0.0, 0.0, -80.0});
  double away = 0.0;
  for (int i = 0; i < 30; ++i) {
    world.Step(kFrame_s);
    away = std::max(away, test::LargestDistance(world.StateOf(person).posture, StandingPerson()));
  }
  EXPECT_GT(away, 0.03);  // it gave way ...
  EXPECT_LT(test::LargestDistance(world.StateOf(person).posture, StandingPerson()), 0.005);
}

TEST(Anthropometry, MassesSumToTheBodyMass) {
  const auto segments = ComputeSegments(Lengths(), 1.75, 70.0);
  double sum = 0.0, lumped = 0.0;
  for (const auto& segment : segments) sum += segment.mass_kg;
  for (const double m : LumpedMasses(segments)) lumped += m;
  EXPECT_NEAR(sum, 70.0, 1e-9);
  EXPECT_NEAR(lumped, 70.0, 1e-9);
}

TEST(Anthropometry, RadiiOfGyrationAreBelowHalfTheLength) {
  // The premise of the damping derivation in control.h: rho >= 1, and <= 3.65.
  const auto segments = ComputeSegments(Lengths());
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    const auto& s = segments[i];
    const double rho = 0.25 * s.mass_kg * s.length_m * s.length_m / s.transverse_inertia_kgm2;
    EXPECT_GE(rho, 1.0) << i;
    EXPECT_LE(rho, 3.65) << i;
  }
}

TEST(Anthropometry, StatureFollowsFromTheBones) {
  EXPECT_NEAR(EstimateStature(Lengths()), 1.75, 0.1);
}

}  // namespace
}  // namespace ossa::physics
