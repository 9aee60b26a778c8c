// Shum & Ho 2012, sec. 8.1: a mace; sec. 8.3: two characters.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "recon/smallest_turn.h"
#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {
namespace {

using Eigen::Vector3d;
using physics::ObjectOptions;
using recon::Joint;
using recon::Posture;

// Constants: of the scenes that are played, by hand.

constexpr double kMaceLength_m = 0.35;

/// Hangs a mace on the right hand, free to turn about it; returns the object.
int AddMace(Stage& stage, int person) {
  const Vector3d hand = stage.world.StateOf(person).posture[Joint::kHandRight];
  ObjectOptions mace;
  mace.shape = physics::Shape::kCapsule;
  mace.size_m = {0.08, kMaceLength_m, 0.08};
  mace.mass_kg = 2.0;
  mace.position_m = hand - Vector3d(0.0, 0.5 * kMaceLength_m + 0.08, 0.0);
  const int index = stage.world.AddObject(mace);
  stage.world.Hold(person, Joint::kHandRight, index, false);
  return index;
}

/// The mace's far end.
Vector3d HeadOf(const physics::ObjectState& mace) {
  return mace.position_m - mace.orientation * Vector3d(0.0, 0.5 * kMaceLength_m, 0.0);
}

struct Swing {
  std::vector<Vector3d> hand;
  Vector3d fastest = Vector3d::Zero();  // where the mace's head was fastest
};

/// The motion without boxes, with or without the mace.
Swing Rehearse(const std::vector<Posture>& motion, uint64_t seed, bool armed) {
  Stage stage(seed, {}, false);
  const int person = stage.AddPerson(motion[0]);
  const int mace = armed ? AddMace(stage, person) : -1;
  Swing swing;
  double best = 0.0;
  Vector3d before = Vector3d::Zero();
  for (size_t f = 0; f < motion.size(); ++f) {
    stage.Advance({motion[f]}, "");
    swing.hand.push_back(stage.world.StateOf(person).posture[Joint::kHandRight]);
    if (!armed) continue;
    const Vector3d head = HeadOf(stage.world.ObjectOf(mace));
    const double speed = (head - before).norm();
    if (f > 5 && speed > best && head.z() > 0.25 && head.y() < 1.1) {
      best = speed;
      swing.fastest = head;
    }
    before = head;
  }
  return swing;
}

/// A heap of boxes that what comes to `place` runs into.
std::vector<Vector3d> HeapBoxes(Stage& stage, const Vector3d& place) {
  constexpr double kEdge_m = 0.22;
  std::vector<Vector3d> start;
  const int layers = std::max(1, static_cast<int>(std::ceil(place.y() / kEdge_m)) + 1);
  for (int layer = 0; layer < layers; ++layer) {
    for (const double side : {-0.5, 0.5}) {
      ObjectOptions box;
      box.size_m = Vector3d::Constant(kEdge_m);
      box.mass_kg = 0.4;
      box.position_m = {place.x() + side * 1.02 * kEdge_m, kEdge_m * (layer + 0.5) + 0.001,
                        place.z() + 0.5 * kEdge_m};
      stage.world.AddObject(box);
      start.push_back(box.position_m);
    }
  }
  return start;
}

struct Throw {
  Joint hand = Joint::kHandRight;
  size_t release = 1;
};

/// The hand that goes fastest towards the other throws, and lets go when it is fastest.
Throw FindThrow(const std::vector<Posture>& motion) {
  Throw found;
  double fastest = 0.0;
  for (const Joint hand : {Joint::kHandLeft, Joint::kHandRight}) {
    for (size_t f = 1; f < motion.size(); ++f) {
      const double speed = 30.0 * (motion[f][hand].z() - motion[f - 1][hand].z());
      if (speed <= fastest) continue;
      fastest = speed;
      found = {hand, f};
    }
  }
  return found;
}

/// Gives the person a box that sits on the hand, beyond its fingers.
int TakeBox(Stage& stage, int person, Joint hand) {
  constexpr double kEdge_m = 0.16;
  const Posture now = stage.world.StateOf(person).posture;
  const Joint wrist = hand == Joint::kHandLeft ? Joint::kWristLeft : Joint::kWristRight;
  const Vector3d along = (now[hand] - now[wrist]).normalized();
  ObjectOptions box;
  box.size_m = Vector3d::Constant(kEdge_m);
  box.mass_kg = 0.5;
  box.orientation = recon::SmallestTurn(Vector3d::UnitY(), along);
  const double outwards = hand == Joint::kHandLeft ? 0.03 : -0.03;  // clear of the thigh
  box.position_m = now[hand] + (0.5 * kEdge_m + 0.04) * along;
  box.position_m += now[Joint::kHipLeft].x() > now[Joint::kHipRight].x()
                        ? Vector3d(outwards, 0.0, 0.0)
                        : Vector3d(-outwards, 0.0, 0.0);
  const int index = stage.world.AddObject(box);
  stage.world.Hold(person, hand, index, true);
  return index;
}

/// Where a thrown box comes down to the height of a chest, thrown by a person alone.
Vector3d RehearseThrow(const std::vector<Posture>& motion, const Throw& how, uint64_t seed) {
  Stage stage(seed, {}, false);
  const int person = stage.AddPerson(motion[0]);
  const int box = TakeBox(stage, person, how.hand);
  Vector3d place = Vector3d::Zero();
  for (size_t f = 0; f < how.release + 60; ++f) {
    stage.Advance({motion[std::min(f, motion.size() - 1)]}, "");
    if (f == how.release) stage.world.Release(box);
    if (f <= how.release) continue;
    const Vector3d at = stage.world.ObjectOf(box).position_m;
    if (at.y() < 1.05 && place.z() > 1.0) break;
    place = at;
  }
  return place;
}

}  // namespace

SceneResult SwingAMace(const Actors& actors, uint64_t seed) {
  const std::vector<Posture> motion = actors.Sequence({"throw", "golf"});
  const Swing bare = Rehearse(motion, seed, false), armed = Rehearse(motion, seed, true);
  SceneView view;
  view.eye_m = {-2.4, 1.7, 2.9};
  view.look_at_m = {0.0, 0.8, 0.5};
  Stage stage(seed, view);
  const int person = stage.AddPerson(motion[0]);
  AddMace(stage, person);
  const std::vector<Vector3d> start = HeapBoxes(stage, armed.fastest);
  for (const Posture& posture : motion) stage.Advance({posture}, "a 2 kg mace on the right hand");
  int hit = 0;
  for (size_t i = 0; i < start.size(); ++i) {
    if ((stage.world.ObjectOf(static_cast<int>(i) + 1).position_m - start[i]).norm() > 0.1) ++hit;
  }
  double mean = 0.0, largest = 0.0;
  for (size_t f = 0; f < motion.size(); ++f) {
    const double d = (bare.hand[f] - armed.hand[f]).norm();
    mean += d / static_cast<double>(motion.size());
    largest = std::max(largest, d);
  }
  SceneResult result;
  result.numbers = {
      {"hand path altered by the mace's mass, mean", Text(100 * mean, 1, "cm"), ">= 0.5 cm",
       mean >= 0.005},
      {"hand path altered, largest", Text(100 * largest, 1, "cm"), ">= 3 cm", largest >= 0.03},
      {"boxes knocked away", std::to_string(hit) + " of " + std::to_string(start.size()), ">= 2",
       hit >= 2}};
  AddCommonNumbers(stage, result);
  return result;
}

SceneResult ThrowBoxes(const Actors& actors, uint64_t seed) {
  const std::vector<Posture>& motion = actors.Play("throw");
  const Throw how = FindThrow(motion);
  const Vector3d place = RehearseThrow(motion, how, seed);
  // Half a turn about the vertical line halfway to where the box comes: each stands where the other
  // throws.
  const Vector3d chest = motion[0][Joint::kShoulderCenter];
  const auto opposite = [&](Posture posture) {
    for (auto& p : posture.position_m) {
      p = Vector3d(place.x() + chest.x() - p.x(), p.y(), place.z() + chest.z() - p.z());
    }
    return posture;
  };
  SceneView view;
  view.eye_m = {0.5 * place.x() + 1.1 * place.z() + 1.4, 1.8, 0.5 * place.z() + 0.3};
  view.look_at_m = {0.5 * place.x(), 0.9, 0.5 * place.z()};
  Stage stage(seed, view);
  stage.AddPerson(motion[0]);
  stage.AddPerson(opposite(motion[0]));
  const int boxes[2] = {TakeBox(stage, 0, how.hand), TakeBox(stage, 1, how.hand)};
  const size_t delay = 45;  // the second character throws a second and a half later
  int hits[2] = {0, 0};     // frames in which the one thrown at was struck
  for (size_t f = 0; f < motion.size() + delay + 20; ++f) {
    const auto at = [&](size_t frame) { return std::min(frame, motion.size() - 1); };
    stage.Advance({motion[at(f)], opposite(motion[at(f < delay ? 0 : f - delay)])},
                  "two characters throw boxes at each other");
    for (size_t thrower = 0; thrower < 2; ++thrower) {
      const size_t released = how.release + thrower * delay;
      if (f == released) stage.world.Release(boxes[thrower]);
      if (f <= released) continue;
      const int target = 1 - static_cast<int>(thrower);
      hits[thrower] += stage.Struck(target, {}, boxes[thrower]) ? 1 : 0;
    }
  }
  SceneResult result;
  result.numbers = {
      {"thrown how far", Text(place.z(), 2, "m"), ">= 1.5 m", place.z() >= 1.5},
      {"frames the first box struck the other", std::to_string(hits[0]), ">= 1", hits[0] >= 1},
      {"frames the second box struck the other", std::to_string(hits[1]), ">= 1", hits[1] >= 1}};
  AddCommonNumbers(stage, result);
  return result;
}

}  // namespace ossa::tools
