// Shum & Ho 2012, sec. 8.1: boxes and a mace; sec. 8.3: two characters.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/experiments/shum_ho_2012_internal.h"

namespace ossa::tools {
namespace {

using Eigen::Vector3d;
using physics::ObjectOptions;
using recon::Joint;
using recon::Posture;

physics::WorldOptions Seeded(uint64_t seed) {
  physics::WorldOptions options;
  options.seed = seed;
  return options;
}

int AddPerson(Stage& stage, const Posture& start, const physics::CharacterOptions& options = {}) {
  return stage.world.AddCharacter(recon::BoneLengthsOf(start), start, options);
}

double Blend(double t, double from, double to) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// Both hands, wrists too, at the sides of something `half_m` wide: user constraints of sec. 6.1.
void PutHands(physics::World& world, int person, const Vector3d& middle, double half_m) {
  for (const double side : {1.0, -1.0}) {
    const Joint hand = side > 0 ? Joint::kHandLeft : Joint::kHandRight;
    const Joint wrist = side > 0 ? Joint::kWristLeft : Joint::kWristRight;
    const Vector3d at = middle + Vector3d(side * half_m, 0.0, 0.0);
    world.Constrain(person, hand, at + Vector3d(0.0, 0.0, 0.04), false);
    world.Constrain(person, wrist, at + Vector3d(side * 0.01, -0.02, -0.05), false);
  }
}

}  // namespace

SceneResult CarryABox(const Actors& actors, uint64_t seed) {
  SceneView view;
  view.eye_m = {2.4, 1.7, 2.6};
  view.look_at_m = {0.3, 0.9, 0.2};
  Stage stage(Seeded(seed), view);
  const std::vector<Posture>& steps = actors.Play("side_steps");
  const int person = AddPerson(stage, steps[0]);
  const double chest_x = steps[0][Joint::kShoulderCenter].x();
  ObjectOptions pedestal;
  pedestal.size_m = {0.3, 0.7, 0.3};
  pedestal.mass_kg = 60.0;
  pedestal.position_m = {chest_x, 0.35, 0.48};
  stage.world.AddObject(pedestal);
  ObjectOptions bulky;
  bulky.size_m = {0.44, 0.36, 0.34};
  bulky.mass_kg = 3.0;
  bulky.friction = 1.0;
  bulky.position_m = {chest_x, 0.89, 0.48};
  const int box = stage.world.AddObject(bulky);

  constexpr double kReach_s = 1.0, kGrip_s = 1.6, kLift_s = 2.6, kRest_s = 0.5;
  int off_floor = 0;
  double highest = 0.0;
  const int frames = 96 + static_cast<int>(steps.size());
  for (int f = 0; f < frames; ++f) {
    const double t = f / 30.0;
    const int walked = std::clamp(f - 90, 0, static_cast<int>(steps.size()) - 1);
    const Posture& body = steps[static_cast<size_t>(walked)];
    // Open hands beside the box, then 6 cm into it: the overlap is the grip.
    const double half = 0.22 + 0.12 * (1.0 - Blend(t, kRest_s, kReach_s)) + 0.05 -
                        0.10 * Blend(t, kReach_s, kGrip_s);
    const Vector3d chest = body[Joint::kShoulderCenter];
    const Vector3d middle(chest.x(), 0.90 + 0.25 * Blend(t, kGrip_s, kLift_s), 0.48);
    if (t > 0.3) PutHands(stage.world, person, middle, half);
    stage.Advance({body}, "lift and carry a bulky box");
    const double lifted = stage.world.ObjectOf(box).position_m.y() - bulky.position_m.y();
    highest = std::max(highest, lifted);
    if (lifted > 0.05) ++off_floor;
  }
  const double carried = (stage.world.ObjectOf(box).position_m - bulky.position_m)
                             .cwiseProduct(Vector3d(1, 0, 1))
                             .norm();
  SceneResult result;
  result.numbers = {
      {"frames with the box in the air", std::to_string(off_floor), ">= 60", off_floor >= 60},
      {"lifted", Text(highest, 2, "m"), ">= 0.15 m", highest >= 0.15},
      {"carried sideways", Text(carried, 2, "m"), ">= 0.3 m", carried >= 0.3}};
  AddCommonNumbers(stage, result);
  return result;
}

SceneResult WalkThroughBoxes(const Actors& actors, uint64_t seed) {
  SceneView view;
  view.eye_m = {3.4, 2.0, 3.0};
  view.look_at_m = {0.0, 0.7, 1.5};
  Stage stage(Seeded(seed), view);
  const std::vector<Posture> motion = actors.Sequence({"walk", "punch", "kick"});
  AddPerson(stage, motion[0]);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<int> boxes;
  std::vector<Vector3d> start;
  for (int row = 0; row < 12; ++row) {
    for (int column = 0; column < 5; ++column) {
      ObjectOptions box;
      const double edge = 0.14 + 0.10 * uniform(random);
      box.size_m = Vector3d::Constant(edge);
      box.mass_kg = 0.15 + 0.25 * uniform(random);  // light, to magnify the impacts
      box.friction = 0.5;
      box.position_m = {-0.6 + 0.3 * column + 0.05 * uniform(random), 0.5 * edge + 0.001,
                        0.7 + 0.3 * (row % 8) + 0.05 * uniform(random)};
      if (row >= 8) box.position_m.y() += 0.27;  // a second layer, falling into place
      boxes.push_back(stage.world.AddObject(box));
      start.push_back(box.position_m);
    }
  }
  int frames_touched = 0;
  for (const Posture& posture : motion) {
    stage.Advance({posture}, "walk, punch, kick: sixty boxes");
    if (stage.world.Contacts().character_object_contacts > 0) ++frames_touched;
  }
  int moved = 0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Vector3d by = stage.world.ObjectOf(boxes[i]).position_m - start[i];
    if (std::hypot(by.x(), by.z()) > 0.1) ++moved;
  }
  SceneResult result;
  result.numbers = {
      {"boxes moved more than 10 cm", std::to_string(moved) + " of 60", ">= 15", moved >= 15},
      {"frames with contact", std::to_string(frames_touched), ">= 30", frames_touched >= 30}};
  AddCommonNumbers(stage, result);
  return result;
}

SceneResult SwingAMace(const Actors& actors, uint64_t seed) {
  const std::vector<Posture> motion = actors.Sequence({"swipe", "punch"});
  std::vector<Vector3d> paths[2];
  SceneResult result;
  int hit = 0;
  for (const bool armed : {false, true}) {
    SceneView view;
    view.eye_m = {-2.2, 1.8, 2.8};
    view.look_at_m = {0.0, 1.0, 0.3};
    Stage stage(Seeded(seed), view);
    const int person = AddPerson(stage, motion[0]);
    std::vector<Vector3d> start;
    if (armed) {
      const Vector3d hand = stage.world.StateOf(person).posture[Joint::kHandRight];
      ObjectOptions mace;
      mace.shape = physics::Shape::kCapsule;
      mace.size_m = {0.08, 0.35, 0.08};
      mace.mass_kg = 2.0;
      mace.position_m = hand - Vector3d(0.0, 0.25, 0.0);
      stage.world.Hold(person, Joint::kHandRight, stage.world.AddObject(mace), false);
      for (int i = 0; i < 8; ++i) {
        ObjectOptions box;
        box.size_m = Vector3d::Constant(0.25);
        box.mass_kg = 0.4;
        box.position_m = {-0.5 + 0.3 * (i % 4), 0.13 + 0.26 * (i / 4), 0.75};
        stage.world.AddObject(box);
        start.push_back(box.position_m);
      }
    }
    for (const Posture& posture : motion) {
      stage.Advance({posture}, "a 2 kg mace on the right hand");
      paths[armed ? 1 : 0].push_back(stage.world.StateOf(person).posture[Joint::kHandRight]);
    }
    for (size_t i = 0; i < start.size(); ++i) {
      if ((stage.world.ObjectOf(static_cast<int>(i) + 1).position_m - start[i]).norm() > 0.1) ++hit;
    }
    if (armed) AddCommonNumbers(stage, result);
  }
  double mean = 0.0, largest = 0.0;
  for (size_t f = 0; f < motion.size(); ++f) {
    const double d = (paths[0][f] - paths[1][f]).norm();
    mean += d / static_cast<double>(motion.size());
    largest = std::max(largest, d);
  }
  result.numbers.insert(
      result.numbers.begin(),
      {{"hand path altered by the mace, mean", Text(100 * mean, 1, "cm"), ">= 0.5 cm",
        mean >= 0.005},
       {"hand path altered, largest", Text(100 * largest, 1, "cm"), ">= 3 cm", largest >= 0.03},
       {"boxes the mace or the hand moved", std::to_string(hit) + " of 8", "any", true}});
  return result;
}

SceneResult ThrowBoxes(const Actors& actors, uint64_t seed) {
  SceneView view;
  view.eye_m = {4.2, 1.9, 1.6};
  view.look_at_m = {0.0, 0.9, 1.6};
  Stage stage(Seeded(seed), view);
  const std::vector<Posture>& motion = actors.Play("throw");
  constexpr double kApart_m = 3.2;
  const auto opposite = [&](Posture posture) {
    for (auto& p : posture.position_m) p = Vector3d(-p.x(), p.y(), kApart_m - p.z());
    return posture;
  };
  AddPerson(stage, motion[0]);
  AddPerson(stage, opposite(motion[0]));
  // The hand that goes fastest towards the other throws, and lets go when it is fastest.
  Joint hand = Joint::kHandRight;
  size_t release = 1;
  double fastest = 0.0;
  for (const Joint candidate : {Joint::kHandLeft, Joint::kHandRight}) {
    for (size_t f = 1; f < motion.size(); ++f) {
      const double speed = 30.0 * (motion[f][candidate].z() - motion[f - 1][candidate].z());
      if (speed <= fastest) continue;
      fastest = speed;
      release = f;
      hand = candidate;
    }
  }
  const size_t delay = 30;  // the second character throws a second later
  const auto hold = [&](int person) {
    ObjectOptions box;
    box.size_m = Vector3d::Constant(0.16);
    box.mass_kg = 0.3;
    box.position_m = stage.world.StateOf(person).posture[hand] + Vector3d(0.0, 0.02, 0.0);
    const int index = stage.world.AddObject(box);
    stage.world.Hold(person, hand, index, true);
    return index;
  };
  const int boxes[2] = {hold(0), hold(1)};
  double flown[2] = {0.0, 0.0};
  int64_t hits = 0;
  for (size_t f = 0; f < motion.size() + delay + 20; ++f) {
    const auto at = [&](size_t frame) { return std::min(frame, motion.size() - 1); };
    stage.Advance({motion[at(f)], opposite(motion[at(f < delay ? 0 : f - delay)])},
                  "two characters throw boxes at each other");
    if (f == release + 1) stage.world.Release(boxes[0]);
    if (f == release + 1 + delay) stage.world.Release(boxes[1]);
    if (f > release + 5) hits += std::ssize(stage.world.Contacts().struck);
    flown[0] = std::max(flown[0], stage.world.ObjectOf(boxes[0]).position_m.z());
    flown[1] = std::max(flown[1], kApart_m - stage.world.ObjectOf(boxes[1]).position_m.z());
  }
  SceneResult result;
  result.numbers = {{"first box came", Text(flown[0], 2, "m"), ">= 1.5 m", flown[0] >= 1.5},
                    {"second box came", Text(flown[1], 2, "m"), ">= 1.5 m", flown[1] >= 1.5},
                    {"contacts with the one thrown at", std::to_string(hits), "any", true}};
  AddCommonNumbers(stage, result);
  return result;
}

}  // namespace ossa::tools
