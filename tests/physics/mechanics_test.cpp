// The world against closed-form mechanics.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "physics/anthropometry.h"
#include "physics/control_internal.h"
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

// A ball of restitution e rises to e^2 of the height from which it fell.
TEST(Mechanics, BallReboundsByItsBounce) {
  World world;
  world.SetFloor(test::Ground());
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.size_m = Vector3d::Constant(0.2);
  ball.bounce = 0.6;
  ball.position_m = {0.0, 1.1, 0.0};
  const int index = world.AddObject(ball);
  double highest_m = 0.0;
  for (int i = 0; i < 45; ++i) {
    world.Step(kFrame_s);
    const ObjectState state = world.ObjectOf(index);
    if (i > 15) highest_m = std::max(highest_m, state.position_m.y() - 0.1);
  }
  // The bounce begins up to a substep's 1.5 cm off the touch; air drag takes 5 % of the speed.
  EXPECT_NEAR(highest_m, 0.36, 0.03);
}

/// Speeds of a ball that falls on the floor, in the substeps before and after it bounces, m/s.
std::pair<double, double> SpeedsAtABounce(double height_m, double mass_kg) {
  World world;
  world.SetFloor(test::Ground());
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.size_m = Vector3d::Constant(0.2);
  ball.mass_kg = mass_kg;
  ball.bounce = 0.6;
  ball.position_m = {0.0, 0.1 + height_m, 0.0};
  const int index = world.AddObject(ball);
  double down_m_s = 0.0, up_m_s = 0.0;
  WorldCallbacks callbacks;
  callbacks.before_substep = [&](double) {
    const double v_m_s = world.ObjectOf(index).velocity_m_s.y();
    down_m_s = std::max(down_m_s, -v_m_s);
    up_m_s = std::max(up_m_s, v_m_s);
  };
  world.SetCallbacks(callbacks);
  for (int i = 0; i < 20; ++i) world.Step(kFrame_s);
  return {down_m_s, up_m_s};
}

// Wherever in a substep the ball touches the floor, and whatever its mass.
TEST(Mechanics, SpeedAfterABounceIsRestitutionTimesTheSpeedBefore) {
  for (const double mass_kg : {0.06, 1.0, 20.0}) {
    for (int i = 0; i < 12; ++i) {
      const auto [down_m_s, up_m_s] = SpeedsAtABounce(0.8 + 0.0037 * i, mass_kg);
      // The ball may touch in the substep that follows, when gravity has added 1 % more.
      EXPECT_NEAR(up_m_s / down_m_s, 0.6, 0.006) << mass_kg << " kg, from " << i;
    }
  }
}

/// The speed at which a ball that flew at a person's chest flies back.
double SpeedBackFromAChest(double distance_m) {
  WorldOptions weightless;
  weightless.gravity_m_s2 = 0.0;
  World world(weightless);
  const Vector3d chest_m = StandingPerson().position_m[recon::Index(recon::Joint::kSpine)];
  world.AddCharacter(Lengths(), StandingPerson(), Free());
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.size_m = Vector3d::Constant(0.2);
  ball.mass_kg = 0.4;
  ball.bounce = 0.6;
  ball.position_m = chest_m - Vector3d(0.0, 0.0, distance_m);
  ball.velocity_m_s = {0.0, 0.0, 5.0};
  const int index = world.AddObject(ball);
  for (int i = 0; i < 6; ++i) world.Step(kFrame_s);
  return -world.ObjectOf(index).velocity_m_s.z();
}

// A substep carries the ball 17 mm: its contact with the chest begins anywhere before.
TEST(Mechanics, BallBouncesOffAPersonAlikeWhereverASubstepEnds) {
  for (int i = 0; i < 8; ++i) {
    const double back_m_s = SpeedBackFromAChest(0.5 + 0.0021 * i);
    EXPECT_LE(back_m_s, 0.6 * 5.0) << i;  // from a wall
    EXPECT_GE(back_m_s, 0.45 * 5.0) << i << ": the chest gives way, but little";
  }
}

/// Joints of weight 0 follow at three tenths of the rate.
class StepResponse : public testing::TestWithParam<double> {};

TEST_P(StepResponse, IsAsDerived) {
  WorldOptions fine;
  fine.substeps = 100;
  World world(fine);
  CharacterOptions options = Free();
  options.gains.rate_rad_s = 30.0;
  options.lead = 0.0;
  const int person = world.AddCharacter(Lengths(), StandingPerson(), options);
  const double jump = 0.1;  // w^2 jump stays below the bound on accelerations
  const double x0 = world.StateOf(person).posture.position_m[0].x();
  const std::vector<double> weights(recon::kJointCount, GetParam());
  world.SetTarget(person, Moved(StandingPerson(), {jump, 0.0, 0.0}), weights);
  for (int i = 1; i <= 10; ++i) {
    world.Step(0.01);
    const double wt = 30.0 * (0.3 + 0.7 * GetParam()) * i * 0.01;
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

INSTANTIATE_TEST_SUITE_P(Weights, StepResponse, testing::Values(1.0, 0.5),
                         [](const auto& info) { return info.param == 1.0 ? "whole" : "half"; });

// Eqs. 1 and 2 in numbers, at a rate of 10/s: 100 per s^2 of error and 20 per s of its derivative;
// half the stiffness is half the rate.
TEST(Control, ForceIsEquation1Bounded) {
  ControlGains gains;
  gains.rate_rad_s = 10.0;
  gains.max_acceleration_m_s2 = 50.0;
  const Vector3d x = Vector3d::UnitX();
  EXPECT_LT((ControlForce(gains, 1.0, 2.0, 0.1 * x, 0.3 * x) - 2.0 * 16.0 * x).norm(), 1e-9);
  EXPECT_LT((ControlForce(gains, 0.5, 2.0, 0.1 * x, 0.3 * x) - 2.0 * 5.5 * x).norm(), 1e-9);
  const Vector3d bounded = ControlForce(gains, 1.0, 2.0, {3.0, -4.0, 0.0}, Vector3d::Zero());
  EXPECT_LT((bounded - 2.0 * 50.0 * Vector3d(0.6, -0.8, 0.0)).norm(), 1e-9);
}

TEST(Control, TorqueIsEquation2Bounded) {
  ControlGains gains;
  gains.rate_rad_s = 10.0;
  gains.max_angular_acceleration_rad_s2 = 50.0;
  EXPECT_NEAR(ControlTorque(gains, 1.0, 0.02, 0.1, -0.3), 0.02 * 4.0, 1e-12);
  EXPECT_NEAR(ControlTorque(gains, 0.5, 0.02, 0.1, -0.3), 0.02 * -0.5, 1e-12);
  EXPECT_NEAR(ControlTorque(gains, 1.0, 0.02, 2.0, 0.0), 0.02 * 50.0, 1e-12);
  EXPECT_NEAR(ControlTorque(gains, 1.0, 0.02, -2.0, 0.0), -0.02 * 50.0, 1e-12);
}

Vector3d CentreOfMass(const recon::Posture& posture) {
  const auto segments = ComputeSegments(Lengths());
  Vector3d sum = Vector3d::Zero();
  double mass_kg = 0.0;
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    const auto& p = posture.position_m;
    sum += segments[i].mass_kg * 0.5 * (p[i] + p[recon::ParentOf(i)]);
    mass_kg += segments[i].mass_kg;
  }
  return sum / mass_kg;
}

// Nothing pulls them down, and nothing controls them.
std::pair<World, int> SomebodyAdrift() {
  WorldOptions weightless;
  weightless.gravity_m_s2 = 0.0;
  World world(weightless);
  const int person = world.AddCharacter(Lengths(), StandingPerson(), Free());
  world.StopControl(person);
  return {std::move(world), person};
}

// Without gravity a push on an arm moves the centre of mass at constant speed, whatever the joints'
// forces, and closing the gaps that the solver leaves does not move it.
TEST(Mechanics, PushMovesTheCentreOfMassAtConstantSpeed) {
  auto [world, person] = SomebodyAdrift();
  const Vector3d start = CentreOfMass(world.StateOf(person).posture);
  const Vector3d impulse(10.0, -3.0, 5.0);
  world.ApplyImpulse(person, recon::Joint::kWristLeft, impulse);
  double mass_kg = 0.0;
  for (const auto& segment : ComputeSegments(Lengths())) mass_kg += segment.mass_kg;
  for (int i = 1; i <= 15; ++i) {
    world.Step(kFrame_s);
    const Vector3d moved = CentreOfMass(world.StateOf(person).posture) - start;
    EXPECT_LT((moved - i * kFrame_s / mass_kg * impulse).norm(), 1e-5) << i;  // rounding
  }
}

TEST(Mechanics, ImpulseAddsToTheMomentum) {
  auto [world, person] = SomebodyAdrift();
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

// The derivation in character.h: no mode is underdamped, rho >= 1, and semi-implicit Euler is
// stable at the largest rate, rho (w h)^2 + 4 rho w h < 4.
TEST(LargestStableRate, IsStableForEverySegment) {
  const double wh = LargestStableRate(0.01) * 0.01;
  EXPECT_GT(wh, 0.2);  // not needlessly slow: the bound is 0.257
  const auto segments = ComputeSegments(Lengths());
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    const auto& s = segments[i];
    const double rho = 0.25 * s.mass_kg * s.length_m * s.length_m / s.transverse_inertia_kgm2;
    EXPECT_GE(rho, 1.0) << i;
    EXPECT_LT(rho * wh * wh + 4.0 * rho * wh, 4.0) << i;
  }
}

struct PublishedSegment {
  recon::Joint joint;
  double mass, across, along;
};

// De Leva 1996, table 4, means of men and women: shares of the body's mass, and radii of gyration
// as shares of the length; across: mean of the sagittal and the transverse one.
TEST(Anthropometry, LimbsAreThoseOfDeLeva) {
  using recon::Joint;
  const auto segments = ComputeSegments(Lengths(), 1.75, 70.0);
  for (const PublishedSegment& published :
       {PublishedSegment{Joint::kElbowLeft, 0.0263, 0.273, 0.153},
        PublishedSegment{Joint::kWristLeft, 0.0150, 0.265, 0.1075},
        PublishedSegment{Joint::kKneeLeft, 0.1447, 0.348, 0.1555},
        PublishedSegment{Joint::kAnkleLeft, 0.0457, 0.2605, 0.098},
        PublishedSegment{Joint::kFootLeft, 0.0133, 0.270, 0.1315}}) {
    const Segment& s = segments[recon::Index(published.joint)];
    const double across = std::sqrt(s.transverse_inertia_kgm2 / s.mass_kg) / s.length_m;
    const double along = std::sqrt(s.axial_inertia_kgm2 / s.mass_kg) / s.length_m;
    EXPECT_NEAR(s.mass_kg, 70.0 * published.mass, 0.02 * 70.0 * published.mass);
    EXPECT_NEAR(across, published.across, 0.02 * published.across);
    EXPECT_NEAR(along, published.along, 0.02 * published.along);
    // A cylinder of the tissue's density.
    const double volume_m3 = M_PI * s.radius_m * s.radius_m * s.length_m;
    if (published.joint != Joint::kFootLeft) {
      EXPECT_NEAR(s.mass_kg / volume_m3, 1080.0, 1.0);
    }
  }
}

TEST(Anthropometry, AnUnknownMassIsThatOfABodyMassIndexOf22) {
  double mass_kg = 0.0;
  for (const auto& segment : ComputeSegments(Lengths(), 1.8)) mass_kg += segment.mass_kg;
  EXPECT_NEAR(mass_kg, 22.0 * 1.8 * 1.8, 1e-9);
}

TEST(Anthropometry, StatureFollowsFromTheBones) {
  EXPECT_NEAR(EstimateStature(Lengths()), 1.75, 0.1);
}

}  // namespace
}  // namespace ossa::physics
