// Grips that rotate and slip: hands that carry an object together do not work against each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/world.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::Ground;
using test::kFrame_s;
using test::Lengths;
using test::Moved;
using test::StandingPerson;

ObjectOptions Box(const Vector3d& position_m) {
  ObjectOptions box;
  box.mass_kg = 2.0;
  box.position_m = position_m;
  return box;
}

/// Rotation of a box of 2 kg in a hand that holds it at its end, 20 cm from its middle.
double TurnInHand_rad(double torque_nm) {
  World world;
  world.SetFloor(Ground());
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  const int box = world.AddObject(Box(StandingPerson()[Joint::kHandRight] + Vector3d(0, 0, 0.2)));
  world.Hold(person, Joint::kHandRight, box, true, 1e4, torque_nm);
  const auto in_hand = [&] {
    const Eigen::Quaterniond hand =
        world.StateOf(person).orientation[recon::Index(Joint::kHandRight)];
    return hand.conjugate() * world.ObjectOf(box).orientation;
  };
  const Eigen::Quaterniond before = in_hand();
  for (int f = 0; f < 30; ++f) {
    world.SetTarget(person, StandingPerson());
    world.Step(kFrame_s);
  }
  const Vector3d hand = world.StateOf(person).posture[Joint::kHandRight];
  EXPECT_NEAR((world.ObjectOf(box).position_m - hand).norm(), 0.2, 0.01);  // it does not leave
  return before.angularDistance(in_hand());
}

TEST(Hold, ObjectSlipsInTheHandAboveTheTorque) {
  EXPECT_LT(TurnInHand_rad(20.0), 0.1);
  EXPECT_GT(TurnInHand_rad(0.5), 0.5);
}

/// Two people side by side, whose inner arms are moved together or apart.
struct Pair {
  World world;
  recon::Posture first = StandingPerson(), second = Moved(first, {1.1, 0, 0});
  int a = 0, b = 0;

  Pair() {
    world.SetFloor(Ground());
    a = world.AddCharacter(Lengths(), first);
    b = world.AddCharacter(Lengths(), second);
  }
  void ReachForEachOther(double nearer_m = 0.05) {
    recon::Posture left = first, right = second;
    for (const Joint j : {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft}) {
      left[j].x() += nearer_m;
    }
    for (const Joint j : {Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight}) {
      right[j].x() -= nearer_m;
    }
    for (int f = 0; f < 120; ++f) {
      world.SetTarget(a, left);
      world.SetTarget(b, right);
      world.Step(kFrame_s);
    }
  }
  Vector3d Hand() const { return world.StateOf(a).posture[Joint::kHandLeft]; }
};

/// Distance of a hand from its position without the box that both hold, and how far the box sinks.
std::pair<double, double> KeptFromWhereItIsWanted_m(double torque_nm) {
  Pair free, holding;
  const Vector3d middle =
      0.5 * (holding.first[Joint::kHandLeft] + holding.second[Joint::kHandRight]);
  const int box = holding.world.AddObject(Box(middle));
  holding.world.Hold(holding.a, Joint::kHandLeft, box, true, 1e4, torque_nm);
  holding.world.Hold(holding.b, Joint::kHandRight, box, true, 1e4, torque_nm);
  free.ReachForEachOther();
  holding.ReachForEachOther();
  const double low_m = middle.y() - holding.world.ObjectOf(box).position_m.y();
  return {(holding.Hand() - free.Hand()).norm(), low_m};
}

TEST(Hold, HandsOfTwoPeopleSlipUntilTheyReachTheirTargets) {
  const auto [kept_m, low_m] = KeptFromWhereItIsWanted_m(0.5);
  EXPECT_LT(kept_m, 0.03);
  EXPECT_LT(std::abs(low_m), 0.02);
  EXPECT_GT(KeptFromWhereItIsWanted_m(std::numeric_limits<double>::infinity()).first, 0.04);
}

TEST(Hold, SeparatingHandsDoNotSlipOffTheObject) {
  Pair pair;
  const Vector3d middle = 0.5 * (pair.first[Joint::kHandLeft] + pair.second[Joint::kHandRight]);
  const int box = pair.world.AddObject(Box(middle));
  const double taken_off_m = pair.world.DistanceTo(box, pair.first[Joint::kHandLeft]);
  pair.world.Hold(pair.a, Joint::kHandLeft, box, true, 1e4, 0.5);
  pair.world.Hold(pair.b, Joint::kHandRight, box, true, 1e4, 0.5);
  pair.ReachForEachOther(-0.5);
  EXPECT_LT(pair.world.DistanceTo(box, pair.Hand()), taken_off_m + 0.22);
}

}  // namespace
}  // namespace ossa::physics
