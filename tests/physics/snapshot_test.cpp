// World::Save and Restore: the same calls after them, the same bytes.
#include <gtest/gtest.h>

#include <thread>

#include "physics/world.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::kFrame_s;

/// Two people, one with a mace, one who holds on to a swinging bar; boxes between them.
struct Scene {
  World world;
  int dancer = 0, other = 0;
  int frame = 0;

  Scene() {
    world.SetFloor(test::Ground());
    CharacterOptions options;
    options.joint_limits = true;
    dancer = world.AddCharacter(test::Lengths(), test::StandingPerson(), options);
    for (const double y : {0.1, 0.3}) {
      ObjectOptions box;
      box.position_m = {0.45, y, 0.1};
      world.AddObject(box);
    }
    other = world.AddCharacter(test::Lengths(), test::Moved(test::StandingPerson(), {1.0, 0, 0}));
    ObjectOptions mace;
    mace.shape = Shape::kCapsule;
    mace.size_m = {0.06, 0.3, 0.06};
    mace.position_m = test::StandingPerson()[Joint::kHandRight] - Vector3d(0, 0.2, 0);
    world.Hold(dancer, Joint::kHandRight, world.AddObject(mace), true, 500.0);
    ObjectOptions plank;
    plank.size_m = {0.1, 0.02, 0.1};
    plank.position_m = {0.66, 0.75, 0.1};
    const int shared = world.AddObject(plank);
    world.Hold(other, Joint::kHandRight, shared, true, 1e4, 0.5);  // slip on it and turn
    world.Hold(other, Joint::kWristRight, shared, true, 1e4, 0.5);
    ObjectOptions bar;
    bar.position_m = {1.4, 1.0, 0.3};
    const int swing = world.AddObject(bar);
    world.Hang(swing, {1.4, 1.6, 0.3});
    world.ApplyImpulseToObject(swing, {0.3, 0, 0}, bar.position_m);
    world.ConstrainTo(other, Joint::kHandLeft, swing, {0, 0, -0.1}, true);
    world.Constrain(other, Joint::kHandRight, {0.7, 1.0, 0.3}, false);
  }
  void Run(int frames) {
    for (int f = 0; f < frames; ++f, ++frame) {
      world.SetTarget(dancer, test::DancingPerson(kFrame_s * frame));
      world.SetTarget(other, test::Moved(test::DancingPerson(0.5 + kFrame_s * frame), {1, 0, 0}));
      world.Step(kFrame_s);
    }
  }
};

std::vector<Vector3d> PlacesIn(const World& world) {
  std::vector<Vector3d> places;
  for (const int c : world.Characters()) {
    const recon::Posture posture = world.StateOf(c).posture;
    places.insert(places.end(), posture.position_m.begin(), posture.position_m.end());
    for (const auto& q : world.StateOf(c).orientation) places.push_back(q.vec());
  }
  for (const int o : world.Objects()) {
    places.push_back(world.ObjectOf(o).position_m);
    places.push_back(world.ObjectOf(o).velocity_m_s);
  }
  for (const Contact& contact : world.Contacts().contacts) places.push_back(contact.impulse_ns);
  return places;
}

TEST(Snapshot, RestoredWorldContinuesIdentically) {
  Scene scene;
  scene.Run(40);
  ASSERT_TRUE(scene.world.StateOf(scene.dancer).left_foot_pinned);
  const WorldSnapshot snapshot = scene.world.Save();
  const int frame = scene.frame;
  const auto now = PlacesIn(scene.world);
  scene.Run(40);
  const auto later = PlacesIn(scene.world);
  scene.world.Restore(snapshot);
  EXPECT_EQ(PlacesIn(scene.world), now);
  scene.frame = frame;
  scene.Run(40);
  EXPECT_EQ(PlacesIn(scene.world), later);
}

TEST(Snapshot, ContinuesInAnotherWorld) {
  Scene scene;
  scene.Run(20);
  Scene copy;
  copy.Run(3);
  copy.world.Restore(scene.world.Save());
  copy.frame = scene.frame;
  scene.Run(30);
  copy.Run(30);
  EXPECT_EQ(PlacesIn(copy.world), PlacesIn(scene.world));
  EXPECT_EQ(copy.world.AddObject({}), scene.world.AddObject({}));
}

TEST(Snapshot, ForgetsARemovedMotorCharacter) {
  Scene scene;
  CharacterOptions options;
  options.control = Control::kMotor;
  const auto place = test::Moved(test::StandingPerson(), {3.0, 0, 0});
  scene.world.RemoveCharacter(scene.world.AddCharacter(test::Lengths(), place, options));
  scene.Run(20);
  Scene copy;
  copy.world.Restore(scene.world.Save());
  copy.frame = scene.frame;
  scene.Run(30);
  copy.Run(30);
  EXPECT_EQ(PlacesIn(copy.world), PlacesIn(scene.world));
}

TEST(Snapshot, EmptyOneIsRefused) {
  World world;
  EXPECT_THROW(world.Restore(WorldSnapshot{}), std::invalid_argument);
}

TEST(Worlds, OnSeveralThreadsEqualASingleOne) {
  Scene alone;
  alone.Run(25);
  std::vector<std::vector<Vector3d>> places(4);
  std::vector<std::thread> threads;
  for (auto& own : places) {
    threads.emplace_back([&own] {
      Scene scene;
      scene.Run(25);
      own = PlacesIn(scene.world);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const auto& own : places) EXPECT_EQ(own, PlacesIn(alone.world));
}

}  // namespace
}  // namespace ossa::physics
