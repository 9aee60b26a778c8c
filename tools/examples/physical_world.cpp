// A small physical world without a camera: a standing person picks a mace from a table by a hold
// that can break, and the contact of a falling ball is reported. Then the state is restored. With a
// camera the targets come from a Tracker's bodies (ToPosture) instead of StandardStance.
#include <algorithm>
#include <cstdio>
#include <exception>

#include "physics/world.h"
#include "recon/normalise.h"

using Eigen::Vector3d;
using namespace ossa::physics;
using ossa::recon::Joint;

namespace {

const char* NameOf(const Party& party) {
  if (party.kind == Party::Kind::kFloor) return "the floor";
  return party.kind == Party::Kind::kCharacter ? "the person" : "an object";
}

void PlayFor(World& world, int person, const ossa::recon::Posture& target, double seconds) {
  for (double t = 0.0; t < seconds - 1e-9; t += 1.0 / 30.0) {
    world.SetTarget(person, target);
    world.Step(1.0 / 30.0);
  }
}

ossa::recon::Posture StandOnFloor() {
  ossa::recon::Posture standing = ossa::recon::StandardStance();
  double lowest_m = standing.position_m[0].y();
  for (const Vector3d& p : standing.position_m) lowest_m = std::min(lowest_m, p.y());
  for (Vector3d& p : standing.position_m) p.y() += 0.03 - lowest_m;  // soles on the floor
  return standing;
}

ObjectOptions Table() {
  ObjectOptions table;
  table.kind = BodyKind::kStatic;
  table.size_m = {0.8, 0.05, 0.5};
  table.position_m = {0.0, 0.7, 0.8};
  return table;
}

ObjectOptions BallAboveTable() {
  ObjectOptions ball;
  ball.shape = Shape::kBall;
  ball.size_m = {0.12, 0.12, 0.12};
  ball.mass_kg = 0.5;
  ball.position_m = {0.1, 1.5, 0.8};
  return ball;
}

ObjectOptions MaceBelow(const Vector3d& hand_m) {
  ObjectOptions mace;
  mace.shape = Shape::kCapsule;
  mace.size_m = {0.05, 0.4, 0.05};
  mace.mass_kg = 1.0;
  mace.position_m = hand_m - Vector3d(0.0, 0.3, 0.0);
  return mace;
}

WorldCallbacks Announce() {
  WorldCallbacks callbacks;
  callbacks.on_first_contact = [](const Contact& contact) {
    if (contact.a.kind != Party::Kind::kObject && contact.b.kind != Party::Kind::kObject) return;
    std::printf("%s touches %s with %.2f N s\n", NameOf(contact.a), NameOf(contact.b),
                contact.impulse_ns.norm());
  };
  callbacks.on_broken_hold = [](int object) { std::printf("object %d is torn off\n", object); };
  return callbacks;
}

void Play() {
  World world;
  world.SetFloor(Eigen::Vector4d(0.0, 1.0, 0.0, 0.0));  // y = 0, up is y
  const ossa::recon::Posture standing = StandOnFloor();
  const int person = world.AddCharacter(ossa::recon::MeasureBoneLengths(standing), standing);
  world.AddObject(Table());
  const int ball = world.AddObject(BallAboveTable());
  world.SetCallbacks(Announce());
  PlayFor(world, person, standing, 1.0);
  std::printf("the ball lies at %.2f m\n", world.ObjectOf(ball).position_m.y());

  const ObjectOptions below_hand = MaceBelow(standing[Joint::kHandRight]);
  const int mace = world.AddObject(below_hand);
  world.Hold(person, Joint::kHandRight, mace, true, 150.0);
  const WorldSnapshot before = world.Save();
  world.ApplyForceToObject(mace, {0.0, 0.0, 400.0}, below_hand.position_m);
  PlayFor(world, person, standing, 0.1);

  world.Restore(before);
  PlayFor(world, person, standing, 0.5);
  const double from_hand_m =
      (world.ObjectOf(mace).position_m - world.StateOf(person).posture[Joint::kHandRight]).norm();
  std::printf("as if nobody had pulled, the mace is %.2f m from the hand\n", from_hand_m);
}

}  // namespace

int main() {
  try {
    Play();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "physical_world: %s\n", error.what());
    return 1;
  }
}
