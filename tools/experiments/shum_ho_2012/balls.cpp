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

/// Speed that carries a ball from one place to another in `time_s` under gravity.
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

}  // namespace

SceneResult MeetBalls(const Actors& actors, uint64_t seed) {
  SceneView view;
  view.eye_m = {2.8, 1.7, 3.2};
  view.look_at_m = {0.0, 0.9, 0.6};
  Stage stage(seed, view);
  const std::vector<Posture>& motion = actors.Play("tai_chi");
  const int person = stage.AddPerson(motion[0]);
  // The same without balls, to see what the impacts do.
  Stage calm(seed, view, false);
  const int twin = calm.AddPerson(motion[0]);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int hits = 0;
  double largest = 0.0, at_end = 0.0;
  const size_t last_shot = std::min<size_t>(motion.size() - 45, 240);
  for (size_t f = 0; f < motion.size(); ++f) {
    if (f % 6 == 0 && f < last_shot) {
      ObjectOptions ball = Ball(0.15 + 0.07 * uniform(random), 400.0);
      ball.position_m = {1.5 * uniform(random), 1.2 + 0.3 * uniform(random), 3.0};
      const Posture now = stage.world.StateOf(person).posture;
      const Vector3d goal =
          now[Joint::kSpine] + Vector3d(0.25 * uniform(random), 0.1 + 0.4 * uniform(random), 0.0);
      ball.velocity_m_s = ComputeLaunchVelocity(ball.position_m, goal, 0.5);
      stage.world.AddObject(ball);
    }
    stage.Advance({motion[f]}, "balls of random sizes");
    calm.Advance({motion[f]}, "");
    hits += stage.IsStruck(person, {}) ? 1 : 0;
    at_end = 0.0;
    const Posture a = stage.world.StateOf(person).posture, b = calm.world.StateOf(twin).posture;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      at_end = std::max(at_end, (a.position_m[j] - b.position_m[j]).norm());
    }
    largest = std::max(largest, at_end);
  }
  SceneResult result;
  result.numbers = {
      {"frames in which a ball struck", std::to_string(hits), ">= 20", hits >= 20},
      {"largest give of a joint", Text(100 * largest, 1, "cm"), ">= 2 cm", largest >= 0.02},
      {"left a second after the last ball", Text(100 * at_end, 2, "cm"), "<= 3 cm",
       at_end <= 0.03}};
  AddCommonNumbers(stage, result);
  return result;
}

SceneResult Dodge(const Actors& actors, uint64_t seed) {
  const std::vector<Posture>& motion = actors.Play("t_pose");
  const Posture pose = motion[motion.size() / 2];
  SceneResult result;
  std::vector<Picture> pictures;  // first without, then with
  std::array<int, 2> head_hits{}, forearm_hits{};
  for (const bool dodging : {false, true}) {
    SceneView view;
    view.eye_m = {2.0, 1.8, 3.0};
    view.look_at_m = {0.0, 1.1, 0.4};
    Stage stage(seed, view);
    physics::CharacterOptions character;
    character.dodge = dodging;
    const int person = stage.AddPerson(pose, character);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int f = 0; f < 240; ++f) {
      if (f % 30 == 15 && f < 210) {
        ObjectOptions ball = Ball(0.16 + 0.04 * uniform(random), 100.0);
        const Vector3d head = stage.world.StateOf(person).posture[Joint::kHead];
        ball.position_m = head + Vector3d(0.8 * uniform(random), -0.1, 3.2);
        ball.velocity_m_s = ComputeLaunchVelocity(ball.position_m, head, 0.55);
        stage.world.AddObject(ball);
      }
      stage.Advance({pose}, dodging ? "dodging on" : "dodging off");
      head_hits[dodging ? 1 : 0] += stage.IsStruck(person, {3}) ? 1 : 0;
      forearm_hits[dodging ? 1 : 0] += stage.IsStruck(person, {6, 7, 10, 11}) ? 1 : 0;
    }
    pictures.insert(pictures.end(), stage.pictures().begin(), stage.pictures().end());
    if (dodging) AddCommonNumbers(stage, result);
  }
  result.pictures = std::move(pictures);
  result.numbers.insert(result.numbers.begin(),
                        {{"frames with the head hit, dodging off", std::to_string(head_hits[0]),
                          "> 0", head_hits[0] > 0},
                         {"frames with the head hit, dodging on", std::to_string(head_hits[1]), "0",
                          head_hits[1] == 0},
                         {"frames with a forearm hit, dodging on", std::to_string(forearm_hits[1]),
                          "> 0", forearm_hits[1] > 0}});
  return result;
}

}  // namespace ossa::tools
