// Objects with the usual features of a physics engine: kinds, forces, parts, groups, breakable
// grips, contact reports.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "physics/world.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using recon::Joint;
using test::Ground;
using test::kFrame_s;
using test::Lengths;
using test::Moved;
using test::StandingPerson;

World Weightless() {
  WorldOptions options;
  options.gravity_m_s2 = 0.0;
  return World(options);
}

ObjectOptions Box(const Vector3d& position_m, double mass_kg = 2.0) {
  ObjectOptions box;
  box.mass_kg = mass_kg;
  box.position_m = position_m;
  return box;
}

void Advance(World& world, int frames) {
  for (int f = 0; f < frames; ++f) world.Step(kFrame_s);
}

TEST(Objects, RemovedIdsAreNeverReused) {
  World world;
  const int first = world.AddObject(Box({0, 1, 0})), second = world.AddObject(Box({1, 1, 0}));
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  world.Hold(person, Joint::kHandLeft, first, true);
  world.ConstrainTo(person, Joint::kHandRight, first, {0, 0, 0}, true);
  world.RemoveObject(first);
  EXPECT_EQ(world.Objects(), (std::vector<int>{second}));
  EXPECT_THROW(world.ObjectOf(first), std::out_of_range);
  world.Hold(person, Joint::kHandLeft, second, true);
  world.RemoveCharacter(person);
  EXPECT_TRUE(world.Characters().empty());
  EXPECT_THROW(world.StateOf(person), std::out_of_range);
  Advance(world, 3);
  EXPECT_EQ(world.AddObject(Box({0, 1, 0})), second + 1);
  EXPECT_EQ(world.AddCharacter(Lengths(), StandingPerson()), person + 1);
}

TEST(Objects, AndCharactersAreReset) {
  World world;
  const int box = world.AddObject(Box({2, 1, 0}));
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  const recon::Posture first = world.StateOf(person).posture;
  world.StopControl(person);
  Advance(world, 20);
  ASSERT_LT(world.ObjectOf(box).position_m.y(), 0.0);
  world.ResetObject(box);
  world.ResetCharacter(person);
  EXPECT_EQ(world.ObjectOf(box).position_m, Vector3d(2, 1, 0));
  EXPECT_EQ(world.ObjectOf(box).velocity_m_s.norm(), 0.0);
  EXPECT_LT(test::LargestDistance(world.StateOf(person).posture, first), 1e-9);
  Advance(world, 10);  // it stands again
  EXPECT_LT(test::LargestDistance(world.StateOf(person).posture, first), 0.02);
}

// Air takes the share c dt of an object's speed: x = F / mc (t - (1 - exp(-ct)) / c); the
// integrator's step h adds F h t / 2m.
TEST(Objects, MoveByTheForceOnThem) {
  World world = Weightless();
  const int box = world.AddObject(Box({0, 0, 0}));
  for (int f = 0; f < 30; ++f) {
    world.ApplyForceToObject(box, {2, 0, 0}, world.ObjectOf(box).position_m);
    world.Step(kFrame_s);
  }
  constexpr double kAir_per_s = 0.0005 * 300.0, kStep_s = 1.0 / 300.0;
  const double expected_m =
      (1.0 - (1.0 - std::exp(-kAir_per_s)) / kAir_per_s) / kAir_per_s + 0.5 * kStep_s;
  EXPECT_NEAR(world.ObjectOf(box).position_m.x(), expected_m, 5e-4);
  EXPECT_LT(world.ObjectOf(box).angular_velocity_rad_s.norm(), 1e-6);
  const double speed = world.ObjectOf(box).velocity_m_s.x();
  world.Step(kFrame_s);                                            // the force is over
  EXPECT_NEAR(world.ObjectOf(box).velocity_m_s.x(), speed, 0.01);  // but for the air
}

// A cube's moment of inertia is m a^2 / 6: an impulse at an edge's middle turns it by 0.1 J 6 / m
// a^2.
TEST(Objects, RotateByAnOffCentreImpulse) {
  World world = Weightless();
  const int box = world.AddObject(Box({0, 0, 0}));
  world.ApplyImpulseToObject(box, {0, 1, 0}, {0.1, 0, 0});
  EXPECT_NEAR(world.ObjectOf(box).velocity_m_s.y(), 0.5, 1e-12);
  EXPECT_NEAR(world.ObjectOf(box).angular_velocity_rad_s.z(), 0.1 * 6.0 / (2.0 * 0.04), 1e-9);
}

TEST(Objects, StaticObjectsCarryAndStay) {
  World world;
  world.SetFloor(Ground());
  ObjectOptions table = Box({0, 0.5, 0});
  table.kind = BodyKind::kStatic;
  table.size_m = {1, 0.1, 1};
  const int top = world.AddObject(table), box = world.AddObject(Box({0, 0.7, 0}));
  world.SetObjectVelocity(top, {1, 0, 0});
  Advance(world, 60);
  EXPECT_EQ(world.ObjectOf(top).position_m, Vector3d(0, 0.5, 0));
  EXPECT_NEAR(world.ObjectOf(box).position_m.y(), 0.65, 0.002);
}

TEST(Objects, KinematicObjectsArriveAndPush) {
  World world;
  world.SetFloor(Ground());
  ObjectOptions wall = Box({-0.5, 0.1, 0});
  wall.kind = BodyKind::kKinematic;
  const int pusher = world.AddObject(wall), box = world.AddObject(Box({0, 0.1, 0}));
  const Quaterniond turned(Eigen::AngleAxisd(0.3, Vector3d::UnitY()));
  for (int f = 1; f <= 30; ++f) {
    world.MoveTo(pusher, {-0.5 + f / 30.0, 0.1, 0}, Quaterniond::Identity());
    world.Step(kFrame_s);
    EXPECT_NEAR(world.ObjectOf(pusher).position_m.x(), -0.5 + f / 30.0, 1e-12);
  }
  EXPECT_GT(world.ObjectOf(box).position_m.x(), 0.69);
  world.MoveTo(pusher, {-1, 1, 0}, turned);
  world.Step(kFrame_s);
  EXPECT_LT(world.ObjectOf(pusher).orientation.angularDistance(turned), 1e-9);
  Advance(world, 3);
  EXPECT_EQ(world.ObjectOf(pusher).position_m.x(), -1.0);  // it stays
  EXPECT_THROW(world.MoveTo(box, {0, 0, 0}, turned), std::invalid_argument);
}

// Two balls on a rod that weighs next to nothing: the centre of mass is between them, and the
// moment of inertia that of two points and of the balls themselves.
TEST(Objects, CompoundObjectsAreOneBody) {
  World world = Weightless();
  ObjectOptions dumbbell;
  dumbbell.shape = Shape::kBall;
  dumbbell.size_m = {0.2, 0.2, 0.2};
  dumbbell.mass_kg = 4.0;
  dumbbell.parts = {{Shape::kBall, {0.2, 0.2, 0.2}, {1.0, 0, 0}, Quaterniond::Identity()}};
  const int thing = world.AddObject(dumbbell);
  EXPECT_LT(world.ObjectOf(thing).position_m.norm(), 1e-12);
  world.ApplyImpulseToObject(thing, {0, 0, 3}, {1.0, 0, 0});
  EXPECT_NEAR(world.ObjectOf(thing).velocity_m_s.z(), 0.75, 1e-9);
  const double inertia = 4.0 * 0.25 + 4.0 * 0.4 * 0.01;
  EXPECT_NEAR(world.ObjectOf(thing).angular_velocity_rad_s.y(), -3.0 * 0.5 / inertia, 1e-9);
}

TEST(Objects, CompoundObjectsStandOnAllParts) {
  World world;
  world.SetFloor(Ground());
  ObjectOptions stool = Box({0, 0.5, 0}, 5.0);
  stool.size_m = {0.4, 0.05, 0.4};
  for (const double x : {-0.15, 0.15}) {
    for (const double z : {-0.15, 0.15}) {
      stool.parts.push_back(
          {Shape::kBox, {0.05, 0.4, 0.05}, {x, -0.225, z}, Quaterniond::Identity()});
    }
  }
  const int thing = world.AddObject(stool);
  Advance(world, 60);
  EXPECT_NEAR(world.ObjectOf(thing).position_m.y(), 0.425, 0.003);
  EXPECT_LT(world.ObjectOf(thing).orientation.angularDistance(Quaterniond::Identity()), 0.01);
}

TEST(Objects, MoveAJointThatIsConstrainedToThem) {
  for (const bool hard : {false, true}) {
    World world = Weightless();
    const int person = world.AddCharacter(Lengths(), StandingPerson());
    ObjectOptions handle = Box(StandingPerson()[Joint::kHandRight] + Vector3d(0, 0.1, 0.1));
    handle.kind = BodyKind::kKinematic;
    const int object = world.AddObject(handle);
    world.ConstrainTo(person, Joint::kHandRight, object, {0, 0, -0.1}, hard);
    for (int f = 0; f < 45; ++f) {
      world.MoveTo(object, handle.position_m + Vector3d(0, 0.2 * std::min(1.0, f / 30.0), 0),
                   Quaterniond::Identity());
      world.SetTarget(person, StandingPerson());
      world.Step(kFrame_s);
    }
    const Vector3d point = world.ObjectOf(object).position_m - Vector3d(0, 0, 0.1);
    EXPECT_LT((world.StateOf(person).posture[Joint::kHandRight] - point).norm(),
              hard ? 0.02 : 0.15)  // it would be 0.3 away
        << hard;
  }
}

TEST(Objects, ArePulledByAHardConstraint) {
  World world = Weightless();
  const int person = world.AddCharacter(Lengths(), StandingPerson());
  const Vector3d start = StandingPerson()[Joint::kHandRight] + Vector3d(0, 0, 0.3);
  const int ball = world.AddObject(Box(start, 0.2));
  world.ConstrainTo(person, Joint::kHandRight, ball, {0, 0, -0.1}, true);
  for (int f = 0; f < 60; ++f) {
    world.SetTarget(person, StandingPerson());
    world.Step(kFrame_s);
  }
  const ObjectState state = world.ObjectOf(ball);
  const Vector3d point = state.position_m + state.orientation * Vector3d(0, 0, -0.1);
  EXPECT_LT((world.StateOf(person).posture[Joint::kHandRight] - point).norm(), 0.005);
  EXPECT_LT(state.position_m.z(), start.z() - 0.02);
}

// A hand at rest that holds 2 kg carries 20 N.
TEST(Hold, BreaksAboveItsStrength) {
  for (const double strength_n : {15.0, 60.0}) {
    World world;
    world.SetFloor(Ground());
    const int person = world.AddCharacter(Lengths(), StandingPerson());
    const int box = world.AddObject(Box(StandingPerson()[Joint::kHandRight] - Vector3d(0, 0.2, 0)));
    std::vector<int> told;
    WorldCallbacks callbacks;
    callbacks.on_broken_hold = [&told](int object) { told.push_back(object); };
    world.SetCallbacks(callbacks);
    world.Hold(person, Joint::kHandRight, box, true, strength_n);
    for (int f = 0; f < 45; ++f) {
      world.SetTarget(person, StandingPerson());
      world.Step(kFrame_s);
    }
    const bool fell = world.ObjectOf(box).position_m.y() < 0.2;
    EXPECT_EQ(fell, strength_n < 20.0);
    EXPECT_EQ(told, fell ? std::vector<int>{box} : std::vector<int>{});
  }
}

TEST(Hold, IsSharedByHandsOfTwoPeople) {
  World world;
  world.SetFloor(Ground());
  const recon::Posture first = StandingPerson(), second = Moved(first, {1.0, 0, 0});
  const int a = world.AddCharacter(Lengths(), first), b = world.AddCharacter(Lengths(), second);
  const int box = world.AddObject(Box({0.5, 0.83, 0.1}));  // 6 cm from either hand
  world.Hold(a, Joint::kHandLeft, box, true);
  world.Hold(b, Joint::kHandRight, box, true);
  const auto stand = [&](int frames) {
    for (int f = 0; f < frames; ++f) {
      world.SetTarget(a, first);
      world.SetTarget(b, second);
      world.Step(kFrame_s);
    }
  };
  stand(30);
  EXPECT_EQ(world.HoldersOf(box),
            (std::vector<Holder>{{a, Joint::kHandLeft}, {b, Joint::kHandRight}}));
  const double shared_m = world.ObjectOf(box).position_m.y();
  EXPECT_NEAR(shared_m, 0.83, 0.03);
  world.Release(box, a, Joint::kHandLeft);
  EXPECT_EQ(world.HoldersOf(box), (std::vector<Holder>{{b, Joint::kHandRight}}));
  stand(30);
  EXPECT_LT(world.ObjectOf(box).position_m.y(), shared_m);  // one alone carries it lower,
  EXPECT_GT(world.ObjectOf(box).position_m.y(), 0.6);       // but carries it
  world.RemoveCharacter(b);
  EXPECT_TRUE(world.HoldersOf(box).empty());
}

TEST(Objects, DistanceToTheirSurfaceIsExact) {
  World world;
  ObjectOptions options = Box({1, 0, 0});  // edges of 0.2 m
  options.orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ());
  const int box = world.AddObject(options);
  EXPECT_NEAR(world.DistanceTo(box, {1.3, 0, 0}), 0.2, 1e-12);
  EXPECT_NEAR(world.DistanceTo(box, {1.4, 0.5, 0}), 0.5, 1e-12);  // 0.3, 0.4 from an edge
  EXPECT_NEAR(world.DistanceTo(box, {1.07, 0, 0}), -0.03, 1e-12);
  options.shape = Shape::kCapsule;
  options.size_m = {0.1, 0.4, 0.1};  // lies along x
  const int capsule = world.AddObject(options);
  EXPECT_NEAR(world.DistanceTo(capsule, {1.5, 0, 0}), 0.25, 1e-12);
  EXPECT_NEAR(world.DistanceTo(capsule, {1.1, 0.2, 0}), 0.15, 1e-12);
  options.parts = {{Shape::kBall, {0.2, 0.2, 0.2}, {0, 0.5, 0}}};  // at x = 0.5
  const int compound = world.AddObject(options);
  EXPECT_NEAR(world.DistanceTo(compound, {0.2, 0, 0}), 0.2, 1e-12);
}

TEST(ContactReport, ReportsTheFloorsForceUnderAWeight) {
  World world;
  world.SetFloor(Ground());
  const int box = world.AddObject(Box({0, 0.1, 0}));
  int begun = 0;
  WorldCallbacks callbacks;
  callbacks.on_first_contact = [&begun](const Contact&) { ++begun; };
  world.SetCallbacks(callbacks);
  Advance(world, 60);
  ASSERT_EQ(world.Contacts().contacts.size(), 1U);
  const Contact& contact = world.Contacts().contacts[0];
  EXPECT_EQ(contact.a, (Party{Party::Kind::kObject, box, 0}));
  EXPECT_EQ(contact.b.kind, Party::Kind::kFloor);
  EXPECT_NEAR(contact.impulse_ns.y(), 2.0 * 9.81 * kFrame_s, 0.01);  // m g dt
  EXPECT_GE(contact.points.size(), 3U);
  for (const ContactPoint& point : contact.points) {
    EXPECT_NEAR(point.normal.y(), 1.0, 1e-9);
    EXPECT_NEAR(point.position_m.y(), 0.0, 0.002);
    EXPECT_LT(point.position_m.cwiseAbs().maxCoeff(), 0.11);
  }
  EXPECT_FALSE(contact.began);
  EXPECT_EQ(begun, 1);
}

TEST(ContactReport, ReportsContactsOfTwoPeople) {
  World world;
  world.SetFloor(Ground());
  const int a = world.AddCharacter(Lengths(), Moved(StandingPerson(), {0.3, 0, 0}));
  const int b = world.AddCharacter(Lengths(), Moved(StandingPerson(), {-0.3, 0, 0}));
  for (int f = 0; f < 20; ++f) {
    world.SetTarget(a, Moved(StandingPerson(), {0.3 - 0.015 * f, 0, 0}));
    world.SetTarget(b, Moved(StandingPerson(), {-0.3 + 0.015 * f, 0, 0}));
    world.Step(kFrame_s);
  }
  int met = 0;
  for (const Contact& contact : world.Contacts().contacts) {
    if (contact.a.kind != contact.b.kind || contact.a.id == contact.b.id) continue;
    ++met;
    EXPECT_EQ(contact.a.id, a);
    EXPECT_GT(contact.a.bone, 0U);
    EXPECT_GT(contact.impulse_ns.norm(), 0.0);
  }
  EXPECT_GT(met, 0);
}

TEST(Groups, DecideCollisions) {
  for (const bool meet : {true, false}) {
    World world;
    world.SetFloor(Ground());
    ObjectOptions below = Box({0, 0.1, 0}), above = Box({0, 0.35, 0});
    below.groups = 2;
    above.collides_with = meet ? ~0U : ~2U;
    world.AddObject(below);
    const int top = world.AddObject(above);
    Advance(world, 60);
    EXPECT_NEAR(world.ObjectOf(top).position_m.y(), meet ? 0.3 : 0.1, 0.005);
  }
}

TEST(Callbacks, FilterCollisionsAndActBetweenSubsteps) {
  World world;
  world.SetFloor(Ground());
  world.AddObject(Box({0, 0.1, 0}));
  const int top = world.AddObject(Box({0, 0.35, 0}));
  double simulated_s = 0.0;
  WorldCallbacks callbacks;
  callbacks.may_meet = [](const Party& a, const Party& b) { return a.kind != b.kind; };
  callbacks.before_substep = [&simulated_s](double h_s) { simulated_s += h_s; };
  world.SetCallbacks(callbacks);
  Advance(world, 60);
  EXPECT_NEAR(world.ObjectOf(top).position_m.y(), 0.1, 0.005);
  EXPECT_NEAR(simulated_s, 2.0, 1e-9);
}

}  // namespace
}  // namespace ossa::physics
