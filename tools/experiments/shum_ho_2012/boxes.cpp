// Shum & Ho 2012, sec. 8.1: a bulky box, and many light ones.
#include <algorithm>
#include <cmath>
#include <random>

#include "tools/experiments/shum_ho_2012/internal.h"

namespace ossa::tools {
namespace {

// Constants: of the scenes that are played, by hand.

using Eigen::Vector3d;
using physics::ObjectOptions;
using recon::Joint;
using recon::Posture;

double Blend(double t, double from, double to) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// Position of the elbow for a wrist at `wrist`, bent towards `pole`.
Vector3d PlaceElbow(const Vector3d& shoulder, const Vector3d& wrist, double upper_m, double fore_m,
                    const Vector3d& pole) {
  const double reach = std::min((wrist - shoulder).norm(), 0.999 * (upper_m + fore_m));
  const Vector3d along = (wrist - shoulder).normalized();
  const double before = (upper_m * upper_m - fore_m * fore_m + reach * reach) / (2.0 * reach);
  const double beside = std::sqrt(std::max(0.0, upper_m * upper_m - before * before));
  return shoulder + before * along + beside * (pole - pole.dot(along) * along).normalized();
}

/// Moves hands and wrists to the sides of an object of half width `half_m` (user constraints of
/// sec. 6.1), and the elbows with them.
void PutHands(SceneSimulation& simulation, int person, const Vector3d& middle, double half_m,
              Posture& body) {
  const recon::BoneLengths lengths = recon::MeasureBoneLengths(body);
  for (const double side : {1.0, -1.0}) {
    const size_t hand = static_cast<size_t>(side > 0 ? Joint::kHandLeft : Joint::kHandRight);
    // A little above the centre, so that the box hangs.
    const Vector3d at = middle + Vector3d(side * half_m, 0.06, 0.0);
    const Vector3d wrist = at + Vector3d(side * 0.01, 0.03, -0.04);
    simulation.world.Constrain(person, static_cast<Joint>(hand), at + Vector3d(0.0, 0.0, 0.04),
                               false);
    simulation.world.Constrain(person, static_cast<Joint>(hand - 1), wrist, false);
    body.position_m[hand - 2] = PlaceElbow(body.position_m[hand - 3], wrist, lengths[hand - 2],
                                           lengths[hand - 1], Vector3d(0.8 * side, -0.5, -0.4));
  }
}

/// Bends down, rises, and steps to the side.
std::vector<Posture> LiftingMotion(const ActionClips& clips) {
  std::vector<Posture> motion = clips.Sequence({"pick_up", "side_steps"});
  const auto aside = [start_m = motion[0].position_m[0].x()](const Posture& posture) {
    return std::abs(posture.position_m[0].x() - start_m);
  };
  const auto farthest =
      std::max_element(motion.begin(), motion.end(),
                       [&](const Posture& a, const Posture& b) { return aside(a) < aside(b); });
  motion.erase(farthest + 1, motion.end());
  motion.insert(motion.end(), 20, motion.back());
  return motion;
}

int LowestFrame(const std::vector<Posture>& motion) {
  const auto lowest =
      std::min_element(motion.begin(), motion.end(), [](const Posture& a, const Posture& b) {
        return a[Joint::kShoulderCenter].y() < b[Joint::kShoulderCenter].y();
      });
  return static_cast<int>(lowest - motion.begin());
}

struct Grip {
  ObjectOptions box, stool;
  int lowest = 0;  // the frame in which the person is lowest
};

/// A box on a stool, where the hands of the bent person can reach it.
Grip PlaceBox(const std::vector<Posture>& motion) {
  Grip grip;
  grip.lowest = LowestFrame(motion);
  const Vector3d chest = motion[static_cast<size_t>(grip.lowest)][Joint::kShoulderCenter];
  const double feet_z = motion[0][Joint::kFootLeft].z();
  grip.stool.size_m = {0.3, std::max(chest.y() - 0.68, 0.1), 0.28};
  grip.stool.mass_kg = 40.0;
  grip.stool.position_m = {chest.x(), 0.5 * grip.stool.size_m.y(),
                           std::max(chest.z() + 0.05, feet_z + 0.26)};
  grip.box.size_m = {0.40, 0.32, 0.26};
  grip.box.mass_kg = 3.0;
  grip.box.friction = 1.0;
  grip.box.position_m = grip.stool.position_m;
  grip.box.position_m.y() = grip.stool.size_m.y() + 0.5 * grip.box.size_m.y() + 0.001;
  return grip;
}

/// A wall of light boxes at arm's length in front of a standing person, shoulder-high and wider
/// than the shoulders: fists reach its upper half, feet its lower half.
std::vector<int> BuildWall(SceneSimulation& simulation, const Posture& standing) {
  constexpr double kEdge_m = 0.26, kBefore_m = 0.42;
  const Vector3d chest = standing[Joint::kShoulderCenter];
  const int layers = static_cast<int>(std::ceil((chest.y() + 0.1) / kEdge_m));
  std::vector<int> boxes;
  for (int layer = 0; layer < layers; ++layer) {
    for (const double column : {-1.0, 0.0, 1.0}) {
      ObjectOptions box;
      box.size_m = Vector3d::Constant(kEdge_m);
      box.mass_kg = 0.3;
      box.position_m = {chest.x() + column * 1.02 * kEdge_m, kEdge_m * (layer + 0.5) + 0.001,
                        chest.z() + kBefore_m + 0.5 * kEdge_m};
      boxes.push_back(simulation.world.AddObject(box));
    }
  }
  return boxes;
}

std::vector<int> ScatterBoxes(SceneSimulation& simulation, uint64_t seed, double from_z_m,
                              double until_z_m) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<int> boxes;
  for (int k = 0; k < 48; ++k) {
    ObjectOptions box;
    const double edge = 0.14 + 0.10 * uniform(random);
    box.size_m = Vector3d::Constant(edge);
    box.mass_kg = 0.15 + 0.25 * uniform(random);  // light, to magnify the impacts
    box.friction = 0.5;
    const int row = k / 4 % 6, layer = k / 24;
    box.position_m = {-0.5 + 0.3 * (k % 4) + 0.08 * uniform(random),
                      0.5 * edge + 0.001 + 0.27 * layer,
                      from_z_m + (until_z_m - from_z_m) * row / 6.0 + 0.08 * uniform(random)};
    boxes.push_back(simulation.world.AddObject(box));
  }
  return boxes;
}

int CountMoved(const SceneSimulation& simulation, const std::vector<int>& boxes,
               const std::vector<Vector3d>& start) {
  return static_cast<int>(std::count_if(boxes.begin(), boxes.end(), [&](int box) {
    const Vector3d by = simulation.world.ObjectOf(box).position_m - start[static_cast<size_t>(box)];
    return std::hypot(by.x(), by.z()) > 0.1;
  }));
}

/// The motion of the box of CarryABox().
struct CarriedBox {
  Vector3d start_m;
  Vector3d end_m = start_m;
  int in_the_air = 0;  // frames
  double highest_m = 0.0, tilt_rad = 0.0;

  void Add(const physics::ObjectState& state) {
    end_m = state.position_m;
    const double lifted_m = state.position_m.y() - start_m.y();
    highest_m = std::max(highest_m, lifted_m);
    if (lifted_m > 0.05) ++in_the_air;
    tilt_rad =
        std::max(tilt_rad, std::acos(std::min(1.0, (state.orientation * Vector3d::UnitY()).y())));
  }
  std::vector<SceneNumber> Criteria() const {
    const double carried_m = std::abs(end_m.x() - start_m.x());
    return {
        {"frames with the box in the air", std::to_string(in_the_air), ">= 60", in_the_air >= 60},
        {"lifted", Text(highest_m, 2, "m"), ">= 0.25 m", highest_m >= 0.25},
        {"carried sideways", Text(carried_m, 2, "m"), ">= 0.3 m", carried_m >= 0.3},
        {"largest tilt of the box", Text(57.3 * tilt_rad, 0, "deg"), "<= 45 deg",
         tilt_rad <= 45 / 57.3}};
  }
};

}  // namespace

SceneResult CarryABox(const ActionClips& clips, uint64_t seed) {
  SceneView view;
  view.eye_m = {2.2, 1.5, 2.4};
  view.look_at_m = {0.35, 0.75, 0.25};
  SceneSimulation simulation(seed, view);
  std::vector<Posture> motion = LiftingMotion(clips);
  // The lift begins when both hands have a grip.
  constexpr int kPause = 15;
  const auto lowest = motion.begin() + LowestFrame(motion);
  motion.insert(lowest, kPause, *lowest);
  const int person = simulation.AddPerson(motion[0]);
  const Grip grip = PlaceBox(motion);
  simulation.world.AddObject(grip.stool);
  const int box = simulation.world.AddObject(grip.box);
  const double half_width = 0.5 * grip.box.size_m.x();

  const Vector3d chest_low = motion[static_cast<size_t>(grip.lowest)][Joint::kShoulderCenter];
  const Vector3d kCarried_m(0.0, -0.40, 0.34);

  CarriedBox carried{grip.box.position_m};
  for (int f = 0; f < static_cast<int>(motion.size()); ++f) {
    Posture body = motion[static_cast<size_t>(f)];
    // Hands beside the box, then 8 cm into it: the overlap gives the pressure for friction.
    const double half = half_width + 0.18 - 0.12 * Blend(f, grip.lowest - 20, grip.lowest - 4) -
                        0.12 * Blend(f, grip.lowest - 4, grip.lowest + 4);
    // Target of the box relative to the chest: its initial place, then in front of the belly.
    const double up = Blend(f, grip.lowest + kPause, grip.lowest + kPause + 40);
    const Vector3d from_chest = (1.0 - up) * (grip.box.position_m - chest_low) + up * kCarried_m;
    const Vector3d chest = f < grip.lowest ? chest_low : body[Joint::kShoulderCenter];
    const Vector3d middle = chest + from_chest;
    if (f > grip.lowest - 40) PutHands(simulation, person, middle, half, body);
    simulation.Advance({body}, "lift and carry a bulky box");
    carried.Add(simulation.world.ObjectOf(box));
  }
  SceneResult result;
  result.numbers = carried.Criteria();
  AddCommonNumbers(simulation, result);
  return result;
}

SceneResult WalkThroughBoxes(const ActionClips& clips, uint64_t seed) {
  const std::vector<Posture> fight = clips.Sequence({"punch", "kick"});
  const std::vector<Posture> motion = clips.Sequence({"punch", "kick", "walk"});
  const double end_m = motion.back().position_m[0].z();
  SceneView view;
  view.eye_m = {3.9, 2.2, 0.5 * end_m + 1.2};
  view.look_at_m = {0.0, 0.6, 0.5 * end_m};
  SceneSimulation simulation(seed, view);
  simulation.AddPerson(motion[0]);
  const std::vector<int> wall = BuildWall(simulation, motion[0]);
  const std::vector<int> scattered = ScatterBoxes(simulation, seed, 1.4, end_m + 0.2);
  std::vector<Vector3d> start;
  for (int k = 0; k < simulation.world.ObjectCount(); ++k) {
    start.push_back(simulation.world.ObjectOf(k).position_m);
  }
  int fist = 0, foot = 0, fallen = 0;
  for (size_t f = 0; f < motion.size(); ++f) {
    simulation.Advance({motion[f]}, f < fight.size() ? "punch and kick" : "walk through boxes");
    if (f == fight.size()) fallen = CountMoved(simulation, wall, start);
    if (f > fight.size()) continue;
    fist += simulation.IsStruck(0, {6, 7, 10, 11}) ? 1 : 0;
    foot += simulation.IsStruck(0, {14, 15, 18, 19}) ? 1 : 0;
  }
  const int moved = CountMoved(simulation, scattered, start);
  SceneResult result;
  result.numbers = {
      {"frames in which a fist or forearm struck", std::to_string(fist), ">= 1", fist >= 1},
      {"frames in which a foot or shank struck", std::to_string(foot), ">= 3", foot >= 3},
      {"boxes knocked away by fists and feet",
       std::to_string(fallen) + " of " + std::to_string(wall.size()), ">= 3", fallen >= 3},
      {"boxes moved by walking", std::to_string(moved) + " of 48", ">= 12", moved >= 12}};
  AddCommonNumbers(simulation, result);
  return result;
}

}  // namespace ossa::tools
