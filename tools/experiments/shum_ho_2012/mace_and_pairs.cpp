// Shum & Ho 2012, sec. 8.1: a mace; sec. 8.3: two characters.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/anthropometry.h"
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

/// Attaches a mace to the right hand by a ball joint; returns the object's index.
int AddMace(SceneSimulation& simulation, int person) {
  const Vector3d hand = simulation.world.StateOf(person).posture[Joint::kHandRight];
  ObjectOptions mace;
  mace.shape = physics::Shape::kCapsule;
  mace.size_m = {0.08, kMaceLength_m, 0.08};
  mace.mass_kg = 2.0;
  mace.position_m = hand - Vector3d(0.0, 0.5 * kMaceLength_m + 0.08, 0.0);
  const int index = simulation.world.AddObject(mace);
  simulation.world.Hold(person, Joint::kHandRight, index, false);
  return index;
}

/// Path of the hand without boxes, with or without the mace, metres.
std::vector<Vector3d> HandPath(const std::vector<Posture>& motion, uint64_t seed, bool armed) {
  SceneSimulation simulation(seed, {}, false);
  const int person = simulation.AddPerson(motion[0]);
  if (armed) AddMace(simulation, person);
  std::vector<Vector3d> path;
  for (const Posture& posture : motion) {
    simulation.Advance({posture}, "");
    path.push_back(simulation.world.StateOf(person).posture[Joint::kHandRight]);
  }
  return path;
}

/// Stacks light boxes in a half circle around a standing person, within reach of arm and mace.
std::vector<Vector3d> StackBoxes(SceneSimulation& simulation, const Posture& standing) {
  constexpr double kEdge_m = 0.22, kReach_m = 0.85;
  constexpr int kLayers = 4, kStacks = 5;
  const Vector3d hips = standing[Joint::kHipCenter];
  std::vector<Vector3d> start;
  for (int stack = 0; stack < kStacks; ++stack) {
    const double angle = std::numbers::pi / 6.0 * (stack - kStacks / 2);
    for (int layer = 0; layer < kLayers; ++layer) {
      ObjectOptions box;
      box.size_m = Vector3d::Constant(kEdge_m);
      box.mass_kg = 0.4;
      box.position_m = {hips.x() + kReach_m * std::sin(angle), kEdge_m * (layer + 0.5) + 0.001,
                        hips.z() + kReach_m * std::cos(angle)};
      box.orientation = Eigen::AngleAxisd(angle, Vector3d::UnitY());
      simulation.world.AddObject(box);
      start.push_back(box.position_m);
    }
  }
  return start;
}

/// The throwing hand: the one that moves forward fastest after its highest point. Objects released
/// from a rising hand would fly over the other person.
struct Swing {
  Joint hand = Joint::kHandRight;
  Vector3d at_m = Vector3d::Zero(),
           along_m = Vector3d::UnitZ();  // position and direction at that frame
};

Swing FindSwing(const std::vector<Posture>& motion) {
  Swing found;
  double fastest = 0.0;
  for (const Joint hand : {Joint::kHandLeft, Joint::kHandRight}) {
    for (size_t f = 1; f < motion.size(); ++f) {
      const Vector3d by = motion[f][hand] - motion[f - 1][hand];
      if (by.z() <= fastest || by.y() > 0.0) continue;
      fastest = by.z();
      found = {hand, motion[f][hand], by};
    }
  }
  return found;
}

double Bearing_rad(const Vector3d& v) { return std::atan2(v.x(), v.z()); }

/// Rotates the motion so that the swung object flies towards the mark.
std::vector<Posture> AimAt(std::vector<Posture> motion, const Swing& swing, const Vector3d& mark) {
  constexpr int kTimes = 20;  // iterations: turning moves the hand
  const Vector3d hips = motion[0][Joint::kHipCenter];
  Eigen::AngleAxisd turn(0.0, Vector3d::UnitY());
  for (int k = 0; k < kTimes; ++k) {
    const Vector3d hand = hips + turn * (swing.at_m - hips);
    turn.angle() = Bearing_rad(mark - hand) - Bearing_rad(swing.along_m);
  }
  for (Posture& posture : motion) {
    for (auto& p : posture.position_m) p = hips + turn * (p - hips);
  }
  return motion;
}

/// Distance from the skin to a box, except for the holding arm, metres; negative inside.
double Clearance_m(const SceneSimulation& simulation, int box, const Posture& body, Joint holding) {
  constexpr int kPoints = 9;  // along a bone: 6 cm apart on the longest
  const physics::Segments segments =
      physics::ComputeSegments(recon::MeasureBoneLengths(body), 0.0, 0.0);
  double nearest = 1.0;
  for (size_t j = 1; j < recon::kJointCount; ++j) {
    if (j + 1 >= recon::Index(holding) && j <= recon::Index(holding)) continue;
    const Vector3d& from = body.position_m[recon::ParentOf(j)];
    for (int k = 0; k < kPoints; ++k) {
      const double share = static_cast<double>(k) / (kPoints - 1);
      const Vector3d at = from + share * (body.position_m[j] - from);
      nearest = std::min(nearest, simulation.world.DistanceTo(box, at) - segments[j].radius_m);
    }
  }
  return nearest;
}

/// Puts a box on the hand, beyond the fingers and clear of the body, and makes the person hold it.
int TakeBox(SceneSimulation& simulation, int person, Joint hand) {
  constexpr double kEdge_m = 0.16, kStep_m = 0.01, kFarthest_m = 0.3;
  const Posture now = simulation.world.StateOf(person).posture;
  const Joint wrist = hand == Joint::kHandLeft ? Joint::kWristLeft : Joint::kWristRight;
  const Vector3d along = (now[hand] - now[wrist]).normalized();
  ObjectOptions box;
  box.size_m = Vector3d::Constant(kEdge_m);
  box.mass_kg = 0.5;
  box.orientation = recon::SmallestTurn(Vector3d::UnitY(), along);
  box.position_m = now[hand] + (0.5 * kEdge_m + 0.04) * along;
  const int index = simulation.world.AddObject(box);
  const Vector3d side = (now[Joint::kHipLeft] - now[Joint::kHipRight]).normalized();
  const Vector3d outwards = hand == Joint::kHandLeft ? side : Vector3d(-side);
  for (double by = 0.0; by < kFarthest_m && Clearance_m(simulation, index, now, hand) < 0.0;
       by += kStep_m) {
    simulation.world.SetPose(index, box.position_m + by * outwards, box.orientation);
  }
  simulation.world.Hold(person, hand, index, true);
  return index;
}

/// Smallest distance from trunk and head at which a flying object will pass.
double ClosestPass_m(const physics::ObjectState& flying, const Posture& body) {
  constexpr double kLongest_s = 1.0, kStep_s = 0.01;
  double nearest = 1e9;
  for (double t = 0.0; t < kLongest_s; t += kStep_s) {
    const Vector3d at = flying.position_m + t * flying.velocity_m_s +
                        0.5 * t * t * Vector3d(0.0, -physics::WorldOptions{}.gravity_m_s2, 0.0);
    for (const Joint j : {Joint::kHipCenter, Joint::kSpine, Joint::kShoulderCenter, Joint::kHead}) {
      nearest = std::min(nearest, (at - body[j]).norm());
    }
  }
  return nearest;
}

/// Decides when to release: when the predicted miss distance to the other person is smallest.
class Aim {
 public:
  bool IsNow(const physics::ObjectState& held, const Posture& other) {
    constexpr double kSwing_m_s = 4.0, kGood_m = 0.2;
    const bool swings = held.velocity_m_s.norm() > kSwing_m_s;
    const double passes = swings ? ClosestPass_m(held, other) : 1e9;
    const bool is_now = before_ < kGood_m && passes >= before_;
    before_ = passes;
    return is_now;
  }

 private:
  double before_ = 1e9;
};

/// A box that one person throws at another, and its flight.
struct Throw {
  int box = -1;
  Aim aim;
  bool is_thrown = false;
  Vector3d from_m = Vector3d::Zero();  // where it was let go
  int hits = 0;                        // frames in which it struck the other
  double flew_m = 0.0;                 // distance flown until then

  /// Called in substeps, because a swing of 10 m/s passes the release point within a frame.
  void ReleaseIfAimed(SceneSimulation& simulation, int target) {
    const physics::ObjectState held = simulation.world.ObjectOf(box);
    if (is_thrown || !aim.IsNow(held, simulation.world.StateOf(target).posture)) return;
    simulation.world.Release(box);
    is_thrown = true;
    from_m = held.position_m;
  }
  void CountHits(const SceneSimulation& simulation, int target) {
    if (!is_thrown || !simulation.IsStruck(target, {}, box)) return;
    if (hits == 0) flew_m = (simulation.world.ObjectOf(box).position_m - from_m).norm();
    ++hits;
  }
};

/// Turns a posture by 180 degrees about the vertical line midway between two people who stand
/// `apart_m` from each other along z, the first with the hips at `first`.
Posture FaceBack(Posture posture, const Vector3d& first, double apart_m) {
  for (auto& p : posture.position_m) {
    p = Vector3d(2.0 * first.x() - p.x(), p.y(), 2.0 * first.z() + apart_m - p.z());
  }
  return posture;
}

SceneView ViewOfPair(const Vector3d& first, double apart_m) {
  SceneView view;
  view.eye_m = {first.x() + 1.1 * apart_m + 1.4, 1.8, first.z() + 0.5 * apart_m + 0.3};
  view.look_at_m = {first.x(), 0.9, first.z() + 0.5 * apart_m};
  return view;
}

}  // namespace

SceneResult SwingAMace(const ActionClips& clips, uint64_t seed) {
  const std::vector<Posture> motion = clips.Sequence({"throw", "golf"});
  const auto bare = HandPath(motion, seed, false), armed = HandPath(motion, seed, true);
  SceneView view;
  view.eye_m = {-2.4, 1.7, 2.9};
  view.look_at_m = {0.0, 0.8, 0.5};
  SceneSimulation simulation(seed, view);
  const int person = simulation.AddPerson(motion[0]);
  AddMace(simulation, person);
  const std::vector<Vector3d> start = StackBoxes(simulation, motion[0]);
  for (const Posture& posture : motion)
    simulation.Advance({posture}, "a 2 kg mace on the right hand");
  int hit = 0;
  for (size_t i = 0; i < start.size(); ++i) {
    if ((simulation.world.ObjectOf(static_cast<int>(i) + 1).position_m - start[i]).norm() > 0.1)
      ++hit;
  }
  double mean = 0.0, largest = 0.0;
  for (size_t f = 0; f < motion.size(); ++f) {
    const double d = (bare[f] - armed[f]).norm();
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
  AddCommonNumbers(simulation, result);
  return result;
}

SceneResult ThrowBoxes(const ActionClips& clips, uint64_t seed) {
  constexpr double kApart_m = 3.0;
  const Vector3d first = clips.Get("throw")[0][Joint::kHipCenter];
  const Swing swing = FindSwing(clips.Get("throw"));
  const auto motion = AimAt(clips.Get("throw"), swing, first + Vector3d(0.0, 0.0, kApart_m));
  const auto opposite = [&](const Posture& posture) { return FaceBack(posture, first, kApart_m); };
  SceneSimulation simulation(seed, ViewOfPair(first, kApart_m));
  simulation.AddPerson(motion[0]);
  simulation.AddPerson(opposite(motion[0]));
  Throw throws[2];
  for (const int person : {0, 1}) throws[person].box = TakeBox(simulation, person, swing.hand);
  physics::WorldCallbacks callbacks;
  callbacks.before_substep = [&simulation, &throws](double) {
    for (const int person : {0, 1}) throws[person].ReleaseIfAimed(simulation, 1 - person);
  };
  simulation.world.SetCallbacks(callbacks);
  const size_t delay = 45;  // the second character throws a second and a half later
  for (size_t f = 0; f < motion.size() + delay + 20; ++f) {
    const auto at = [&](size_t frame) { return std::min(frame, motion.size() - 1); };
    simulation.Advance({motion[at(f)], opposite(motion[at(f < delay ? 0 : f - delay)])},
                       "two characters throw boxes at each other");
    for (const int person : {0, 1}) throws[person].CountHits(simulation, 1 - person);
  }
  const double flew_m = std::min(throws[0].flew_m, throws[1].flew_m);
  SceneResult result;
  result.numbers = {
      {"thrown how far, the shorter", Text(flew_m, 2, "m"), ">= 1.5 m", flew_m >= 1.5},
      {"frames the first box struck the other", std::to_string(throws[0].hits), ">= 1",
       throws[0].hits >= 1},
      {"frames the second box struck the other", std::to_string(throws[1].hits), ">= 1",
       throws[1].hits >= 1}};
  AddCommonNumbers(simulation, result);
  return result;
}

}  // namespace ossa::tools
