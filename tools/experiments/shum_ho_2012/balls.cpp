// Shum & Ho 2012, sec. 8.2: balls of random sizes, and dodging.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {
namespace {

using Eigen::Vector3d;
using physics::ObjectOptions;
using recon::Joint;
using recon::Posture;

/// Velocity that brings a ball from `from` to `to` in `time_s` under gravity.
Vector3d ComputeLaunchVelocity(const Vector3d& from, const Vector3d& to, double time_s) {
  return (to - from) / time_s + Vector3d(0.0, 0.5 * 9.81 * time_s, 0.0);
}

ObjectOptions Ball(double diameter_m, double density_kg_m3) {
  ObjectOptions ball;
  ball.shape = physics::Shape::kBall;
  ball.size_m = Vector3d::Constant(diameter_m);
  ball.mass_kg = density_kg_m3 * std::numbers::pi / 6.0 * std::pow(diameter_m, 3);
  ball.bounce = 0.4;
  return ball;
}

double DrawUniform(std::mt19937_64& random) {
  return std::uniform_real_distribution<double>(-1.0, 1.0)(random);
}

/// A ball of 8 to 22 cm thrown at the person's trunk.
ObjectOptions ThrowAtTrunk(const Posture& person, std::mt19937_64& random) {
  ObjectOptions ball = Ball(0.15 + 0.07 * DrawUniform(random), 400.0);
  ball.position_m.x() = 1.5 * DrawUniform(random);
  ball.position_m.y() = 1.2 + 0.3 * DrawUniform(random);
  ball.position_m.z() = 3.0;
  Vector3d goal = person[Joint::kSpine];
  goal.y() += 0.1 + 0.4 * DrawUniform(random);
  goal.x() += 0.25 * DrawUniform(random);
  ball.velocity_m_s = ComputeLaunchVelocity(ball.position_m, goal, 0.5);
  return ball;
}

/// A light ball of 12 to 20 cm thrown at the person's head.
ObjectOptions ThrowAtHead(const Posture& person, std::mt19937_64& random) {
  ObjectOptions ball = Ball(0.16 + 0.04 * DrawUniform(random), 100.0);
  const Vector3d head = person[Joint::kHead];
  ball.position_m = head + Vector3d(0.8 * DrawUniform(random), -0.1, 3.2);
  ball.velocity_m_s = ComputeLaunchVelocity(ball.position_m, head, 0.55);
  return ball;
}

/// Largest distance between the same joints of two postures.
double LargestDistance_m(const Posture& a, const Posture& b) {
  double largest_m = 0.0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    largest_m = std::max(largest_m, (a.position_m[j] - b.position_m[j]).norm());
  }
  return largest_m;
}

/// Hits by balls thrown at the head of a standing person.
struct DodgeRun {
  int head_hits = 0, forearm_hits = 0;  // frames
  std::vector<Picture> pictures;
};

/// Adds the numbers that all scenes share to `result`.
DodgeRun RunDodge(const Posture& pose, bool dodging, uint64_t seed, SceneResult& result) {
  SceneView view;
  view.eye_m = {2.0, 1.8, 3.0};
  view.look_at_m = {0.0, 1.1, 0.4};
  SceneSimulation simulation(seed, view);
  physics::CharacterOptions character;
  character.dodge = dodging;
  const int person = simulation.AddPerson(pose, character);
  std::mt19937_64 random(seed);
  DodgeRun run;
  for (int f = 0; f < 240; ++f) {
    if (f % 30 == 15 && f < 210) {
      simulation.world.AddObject(ThrowAtHead(simulation.world.StateOf(person).posture, random));
    }
    simulation.Advance({pose}, dodging ? "dodging on" : "dodging off");
    run.head_hits += simulation.IsStruck(person, {3}) ? 1 : 0;
    run.forearm_hits += simulation.IsStruck(person, {6, 7, 10, 11}) ? 1 : 0;
  }
  run.pictures = simulation.pictures();
  if (dodging) AddCommonNumbers(simulation, result);
  return run;
}

}  // namespace

SceneResult MeetBalls(const ActionClips& clips, uint64_t seed) {
  SceneView view;
  view.eye_m = {2.8, 1.7, 3.2};
  view.look_at_m = {0.0, 0.9, 0.6};
  SceneSimulation simulation(seed, view);
  const std::vector<Posture>& motion = clips.Get("tai_chi");
  const int person = simulation.AddPerson(motion[0]);
  // The same without balls, as a reference.
  SceneSimulation calm(seed, view, false);
  const int twin = calm.AddPerson(motion[0]);
  std::mt19937_64 random(seed);
  int hits = 0;
  double largest = 0.0, at_end = 0.0;
  const size_t last_shot = std::min<size_t>(motion.size() - 45, 240);
  for (size_t f = 0; f < motion.size(); ++f) {
    if (f % 6 == 0 && f < last_shot) {
      simulation.world.AddObject(ThrowAtTrunk(simulation.world.StateOf(person).posture, random));
    }
    simulation.Advance({motion[f]}, "balls of random sizes");
    calm.Advance({motion[f]}, "");
    hits += simulation.IsStruck(person, {}) ? 1 : 0;
    at_end = LargestDistance_m(simulation.world.StateOf(person).posture,
                               calm.world.StateOf(twin).posture);
    largest = std::max(largest, at_end);
  }
  SceneResult result;
  result.numbers = {
      {"frames in which a ball struck", std::to_string(hits), ">= 20", hits >= 20},
      {"largest give of a joint", Text(100 * largest, 1, "cm"), ">= 2 cm", largest >= 0.02},
      {"left a second after the last ball", Text(100 * at_end, 2, "cm"), "<= 3 cm",
       at_end <= 0.03}};
  AddCommonNumbers(simulation, result);
  return result;
}

SceneResult Dodge(const ActionClips& clips, uint64_t seed) {
  const std::vector<Posture>& motion = clips.Get("t_pose");
  const Posture pose = motion[motion.size() / 2];
  SceneResult result;
  DodgeRun off = RunDodge(pose, false, seed, result);
  const DodgeRun on = RunDodge(pose, true, seed, result);
  result.pictures = std::move(off.pictures);
  result.pictures.insert(result.pictures.end(), on.pictures.begin(), on.pictures.end());
  result.numbers.insert(result.numbers.begin(),
                        {{"frames with the head hit, dodging off", std::to_string(off.head_hits),
                          "> 0", off.head_hits > 0},
                         {"frames with the head hit, dodging on", std::to_string(on.head_hits), "0",
                          on.head_hits == 0},
                         {"frames with a forearm hit, dodging on", std::to_string(on.forearm_hits),
                          "> 0", on.forearm_hits > 0}});
  return result;
}

}  // namespace ossa::tools
