// Leaning out of the way of flying objects, and what is no threat.
#include <gtest/gtest.h>

#include "physics/world.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

/// What a standing person does about a ball, given relative to the head and by its velocity.
struct Reaction {
  Eigen::Vector3d farthest_m = Eigen::Vector3d::Zero();  // of the head from where it was
  bool dodged = false;
};

Reaction ReactTo(const Eigen::Vector3d& from_m, const Eigen::Vector3d& velocity_m_s,
                 bool lean = true) {
  using recon::Joint;
  CharacterOptions options;
  options.dodge = true;
  options.lean = lean;
  World world;
  world.SetFloor(test::Ground());
  const int person = world.AddCharacter(test::Lengths(), test::StandingPerson(), options);
  world.SetTarget(person, test::StandingPerson());
  for (int i = 0; i < 10; ++i) world.Step(test::kFrame_s);
  const Eigen::Vector3d head = world.StateOf(person).posture[Joint::kHead];
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.size_m = Eigen::Vector3d::Constant(0.16);
  ball.mass_kg = 0.1;
  ball.position_m = head + from_m;
  ball.velocity_m_s = velocity_m_s;
  world.AddObject(ball);
  Reaction reaction;
  for (int i = 0; i < 15; ++i) {
    world.Step(test::kFrame_s);
    const auto state = world.StateOf(person);
    reaction.dodged |= state.dodging;
    const Eigen::Vector3d moved = state.posture[Joint::kHead] - head;
    if (moved.norm() > reaction.farthest_m.norm()) reaction.farthest_m = moved;
  }
  return reaction;
}

/// Rise that cancels gravity over the half second of the flight.
constexpr double kLob_m_s = 0.5 * 9.81 * 0.5;

TEST(Lean, MovesTheHeadToTheFreeSide) {
  for (const double side : {1.0, -1.0}) {  // the ball passes to the left or to the right
    const Reaction r = ReactTo({0.08 * side, 0.0, 3.0}, {0.0, kLob_m_s, -6.0});
    EXPECT_LT(side * r.farthest_m.x(), -0.15);
    EXPECT_LT(std::abs(r.farthest_m.z()), 0.1);
  }
  EXPECT_LT(ReactTo({0.08, 0.0, 3.0}, {0.0, kLob_m_s, -6.0}, false).farthest_m.norm(), 0.15);
}

// Straight on, the one would pass a metre above the head, the other hit it; both fall a metre.
TEST(Lean, ExpectsObjectsToFall) {
  EXPECT_GT(ReactTo({0.0, 0.0, 2.7}, {0.0, kLob_m_s, -6.0}).farthest_m.norm(), 0.15);
  EXPECT_LT(ReactTo({0.0, -0.45, 2.7}, {0.0, 0.5, -6.0}).farthest_m.norm(), 0.05);
}

/// Whether a weightless person who moves at this velocity dodges a ball at rest 1 m ahead of them.
bool DodgesARestingBall(const Eigen::Vector3d& velocity_m_s) {
  WorldOptions weightless;
  weightless.gravity_m_s2 = 0.0;
  World world(weightless);
  CharacterOptions options;
  options.dodge = true;
  const int person = world.AddCharacter(test::Lengths(), test::StandingPerson(), options);
  world.StopControl(person);
  world.SetVelocity(person, velocity_m_s);
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.position_m = test::StandingPerson()[recon::Joint::kHead] + Eigen::Vector3d(0.0, 0.0, 1.0);
  world.AddObject(ball);
  world.Step(test::kFrame_s);
  return world.StateOf(person).dodging;
}

TEST(Dodging, AlsoOfWhatAMovingHeadRunsInto) {
  EXPECT_TRUE(DodgesARestingBall({0.0, 0.0, 3.0}));
  EXPECT_FALSE(DodgesARestingBall({0.0, 0.0, -3.0}));
  EXPECT_FALSE(DodgesARestingBall(Eigen::Vector3d::Zero()));
}

TEST(Dodging, IgnoresObjectsFlyingAway) {
  EXPECT_FALSE(ReactTo({0.0, 0.0, 0.6}, {0.0, kLob_m_s, 6.0}).dodged);
}

}  // namespace
}  // namespace ossa::physics
