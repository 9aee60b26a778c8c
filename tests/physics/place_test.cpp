// Consistency after World::Place and rescues: held objects, constraints, velocities, rotations.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/world.h"
#include "recon/orientation.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::Lengths;
using test::StandingPerson;

constexpr double kFrame_s = 1.0 / 30.0;

recon::Posture MovedBy(recon::Posture posture, const Vector3d& by) {
  for (auto& p : posture.position_m) p += by;
  return posture;
}

/// A person with a 2 kg mace in the right hand.
struct Armed {
  explicit Armed(bool rigid = true) {
    world.SetFloor(Eigen::Vector4d(0, 1, 0, 0));
    person = world.AddCharacter(Lengths(), StandingPerson());
    ObjectOptions mace;
    mace.shape = Shape::kCapsule;
    mace.size_m = {0.06, 0.3, 0.06};
    mace.mass_kg = 2.0;
    mace.position_m = Hand() - Vector3d(0.0, 0.2, 0.0);
    thing = world.AddObject(mace);
    world.Hold(person, Joint::kHandRight, thing, rigid);
    Run(StandingPerson(), 30);
  }
  Vector3d Hand() const { return world.StateOf(person).posture[Joint::kHandRight]; }
  Vector3d Mace() const { return world.ObjectOf(thing).position_m; }
  double MaceSpeed() const { return world.ObjectOf(thing).velocity_m_s.norm(); }
  void Run(const recon::Posture& target, int frames) {
    for (int f = 0; f < frames; ++f) {
      world.SetTarget(person, target);
      world.Step(kFrame_s);
    }
  }
  World world;
  int person = 0, thing = 0;
};

class Placed : public testing::TestWithParam<bool> {};

TEST_P(Placed, MovesHeldObjectsAlongAtRest) {
  Armed armed(GetParam());
  const double from_hand_m = (armed.Mace() - armed.Hand()).norm();
  const recon::Posture there = MovedBy(StandingPerson(), {3.0, 0.0, 1.0});
  armed.world.Place(armed.person, there);
  EXPECT_NEAR((armed.Mace() - armed.Hand()).norm(), from_hand_m, 1e-3);  // it turns with the hand
  EXPECT_EQ(armed.MaceSpeed(), 0.0);
  armed.Run(there, 1);
  EXPECT_LT(armed.MaceSpeed(), 0.5);  // left behind it was torn along, 73 m/s
  armed.Run(there, 30);
  EXPECT_LT((armed.Mace() - armed.Hand()).norm(), 0.25);
}

INSTANTIATE_TEST_SUITE_P(Grips, Placed, testing::Values(true, false), [](const auto& info) {
  return info.param ? std::string("Rigid") : std::string("Loose");
});

TEST(Place, KeepsConstraints) {
  for (const bool hard : {false, true}) {
    World world;
    const int person = world.AddCharacter(Lengths(), StandingPerson());
    const Vector3d place = StandingPerson()[Joint::kHandRight] + Vector3d(0.0, 0.15, 0.2);
    world.Constrain(person, Joint::kHandRight, place, hard);
    world.Place(person, StandingPerson());
    for (int f = 0; f < 45; ++f) {
      world.SetTarget(person, StandingPerson());
      world.Step(kFrame_s);
    }
    const Vector3d hand = world.StateOf(person).posture[Joint::kHandRight];
    EXPECT_LT((hand - place).norm(), hard ? 0.01 : 0.06) << hard;
  }
}

TEST(Place, DiscardsPendingImpulses) {
  World world;
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  world.ApplyImpulse(person, Joint::kHandRight, {0.0, 0.0, 50.0});
  world.Place(person, StandingPerson());
  world.SetTarget(person, StandingPerson());
  world.Step(kFrame_s);
  const Vector3d hand = world.StateOf(person).posture[Joint::kHandRight];
  EXPECT_LT((hand - StandingPerson()[Joint::kHandRight]).norm(), 0.01);
}

TEST(SetVelocity, AppliesToHeldObjects) {
  Armed armed;
  armed.world.SetVelocity(armed.person, {0.0, 0.0, 2.0});
  EXPECT_NEAR(armed.MaceSpeed(), 2.0, 1e-9);
}

TEST(Rescue, RestoresHeldObjectsToo) {
  Armed armed;
  armed.world.ApplyImpulse(armed.person, Joint::kHandRight, {1e300, 0.0, 0.0});
  armed.Run(StandingPerson(), 1);
  ASSERT_GT(armed.world.StateOf(armed.person).rescued, 0);
  EXPECT_TRUE(armed.Mace().allFinite());
  EXPECT_LT((armed.Mace() - armed.Hand()).norm(), 0.25);
  armed.Run(StandingPerson(), 2);
  EXPECT_LT(armed.MaceSpeed(), 1.0);
}

TEST(Rescue, LostObjectRestsAtItsLastPosition) {
  World world;
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.velocity_m_s = {1e300, 0.0, 0.0};
  const int thing = world.AddObject(ball);
  world.Step(kFrame_s);
  EXPECT_LT(world.ObjectOf(thing).position_m.norm(), 0.1);  // it has begun to fall anew
  EXPECT_LT(world.ObjectOf(thing).velocity_m_s.norm(), 1.0);
}

/// The angle between two frames about the y axis they share.
double TwistBetween(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  const Vector3d x = a.conjugate() * (b * Vector3d::UnitX());
  return std::atan2(-x.z(), x.x());
}

// The turn of a forearm about itself moves no joint; only the target's orientations tell it.
TEST(SetTarget, TwistsBonesByTheGivenOrientations) {
  constexpr double kTwist_rad = 0.8;
  constexpr size_t kForearm = 6;
  const recon::JointOrientations plain = recon::ComputeOrientations(StandingPerson());
  recon::JointOrientations twisted = plain;
  twisted[kForearm] = plain[kForearm] * Eigen::AngleAxisd(kTwist_rad, Vector3d::UnitY());
  World world;
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  for (int f = 0; f < 60; ++f) {
    world.SetTarget(person, StandingPerson(), {}, twisted);
    world.Step(kFrame_s);
  }
  const CharacterState state = world.StateOf(person);
  EXPECT_NEAR(TwistBetween(plain[kForearm], state.orientation[kForearm]), kTwist_rad, 0.05);
  EXPECT_NEAR(TwistBetween(plain[10], state.orientation[10]), 0.0, 0.05);  // the other one
}

}  // namespace
}  // namespace ossa::physics
