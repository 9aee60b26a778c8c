#pragma once
// Capsule people who handle the objects of a scene, as skeletons or as depth images.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "tests/support/capsule_person.h"
#include "tools/tracker/scene.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker::test {

using recon::Joint;
using tests::CapsulePose;

/// 1 m below the camera, as of tests::EmptyRoom.
inline Eigen::Vector4d Ground() { return {0.0, 1.0, 0.0, 1.0}; }

inline double Ease(double t, double from, double to) {
  const double x = std::clamp((t - from) / (to - from), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

/// Two people who face the camera side by side, ids 1 (at x < 0, the camera's right) and 2: their
/// inner hands are the right one of 1 and the left one of 2.
using Choreography = std::function<std::vector<CapsulePose>(double time_s)>;

inline CapsulePose PersonOf(double height_m, double x_m) {
  CapsulePose pose;
  pose.height_m = height_m;
  pose.feet_m = {x_m, -1.0, 2.6};
  return pose;
}

inline Eigen::Vector3d RightHand(const CapsulePose& pose) {
  return tests::ComputeJoints(pose)[Joint::kHandRight];
}
inline Eigen::Vector3d LeftHand(const CapsulePose& pose) {
  return tests::ComputeJoints(pose)[Joint::kHandLeft];
}

/// Hands up and moved so that the inner hand is there (x, y; the depth is the pose's own).
inline CapsulePose Reaching(CapsulePose pose, bool right, double x_m, double y_m) {
  double& lift_rad = right ? pose.right_lift_rad : pose.left_lift_rad;
  const auto hand = [&] { return right ? RightHand(pose) : LeftHand(pose); };
  double low = 0.0, high = 2.5;
  for (int k = 0; k < 30; ++k) {
    lift_rad = 0.5 * (low + high);
    (hand().y() < y_m ? low : high) = lift_rad;
  }
  pose.feet_m.x() += x_m - hand().x();
  return pose;
}

inline recon::SkeletonFrame SkeletonsOf(const std::vector<CapsulePose>& people, int frame) {
  recon::SkeletonFrame skeletons;
  skeletons.frame = frame;
  skeletons.time_s = frame / 30.0;
  skeletons.floor = Ground();
  for (size_t k = 0; k < people.size(); ++k) {
    recon::BodyRecord& body = skeletons.bodies.emplace_back();
    body.id = static_cast<int>(k) + 1;
    const recon::Posture joints = tests::ComputeJoints(people[k]);
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.joints[j].emplace().position_m = joints.position_m[j];
    }
  }
  return skeletons;
}

/// Observations of a simulated scene.
struct Seen {
  double deepest_m = 0.0;         // a limb in an object
  double deepest_object_m = 0.0;  // an object in another or in the floor
  bool is_finite = true;
  std::vector<SceneEvent> events;
  void Update(Scene& scene) {
    const physics::ContactSummary& contacts = scene.world().Contacts();
    deepest_m = std::max(deepest_m, contacts.character_object_depth_m);
    deepest_object_m = std::max(deepest_object_m, contacts.object_depth_m);
    for (const int character : scene.world().Characters()) {
      is_finite &= scene.world().IsFinite(character);
    }
    events.insert(events.end(), scene.events().begin(), scene.events().end());
  }
  int Count(SceneEvent::Kind kind, int body) const {
    return static_cast<int>(std::count_if(events.begin(), events.end(), [&](const SceneEvent& e) {
      return e.kind == kind && e.body == body;
    }));
  }
};

/// To be called once per frame, after the scene was simulated.
using Observer = std::function<void(double time_s, const recon::SkeletonFrame&, Scene&)>;

inline Seen Play(Scene& scene, const Choreography& people, double seconds,
                 const Observer& observe = {}) {
  Seen seen;
  for (int f = 0; f < static_cast<int>(30.0 * seconds); ++f) {
    recon::SkeletonFrame frame = SkeletonsOf(people(f / 30.0), f);
    scene.Play(frame);
    seen.Update(scene);
    if (observe) observe(f / 30.0, frame, scene);
  }
  return seen;
}

// ---- lifting together

constexpr double kBoxWidth_m = 0.4, kTable_m = 0.65;  // the table's height

/// A box between two people, on a table; people who step up to it, lift it 30 cm in a second and a
/// half, hold it, and from `apart_s` on go apart.
struct Lifting {
  double first_height_m = 1.75, second_height_m = 1.75;
  double apart_s = 100.0;
  int hands = 2;  // how many of the two lift

  SceneOptions Options() const {
    SceneOptions scene;
    SceneObject table;
    table.name = "table";
    table.body.kind = physics::BodyKind::kStatic;
    table.body.size_m = {0.2, kTable_m, 0.3};
    table.body.position_m = {0.0, 0.5 * kTable_m, HandDepth()};
    SceneObject box;
    box.name = "box";
    box.body.size_m = {kBoxWidth_m, 0.3, 0.3};
    box.body.mass_kg = 2.0;
    box.body.position_m = {0.0, kTable_m + 0.151, HandDepth()};
    scene.objects = {table, box};
    GrabRule grab;
    grab.hands = grab.people = 2;
    scene.grabs = {grab};
    scene.releases = {ReleaseRule{}};
    return scene;
  }
  double HandDepth() const { return RightHand(PersonOf(first_height_m, 0.0)).z(); }

  std::vector<CapsulePose> operator()(double t) const {
    const double hand_y_m = -1.0 + kTable_m + 0.16 + 0.3 * Ease(t, 2.5, 4.0);
    const double gap_m = 0.5 * kBoxWidth_m + 0.05 + 0.25 * (1.0 - Ease(t, 0.5, 1.5)) +
                         0.6 * Ease(t, apart_s, apart_s + 1.0);
    CapsulePose first = Reaching(PersonOf(first_height_m, -0.8), true, -gap_m, hand_y_m);
    CapsulePose second = Reaching(PersonOf(second_height_m, 0.8), false, gap_m, hand_y_m);
    if (hands == 1) second = PersonOf(second_height_m, 1.2);
    return {first, second};
  }
};

/// A ball of this diameter, at any place.
inline SceneObject MakeBall(double diameter_m, double mass_kg) {
  SceneObject ball;
  ball.name = "ball";
  ball.body.shape = physics::Shape::kBall;
  ball.body.size_m.setConstant(diameter_m);
  ball.body.mass_kg = mass_kg;
  return ball;
}

// ---- throwing

/// The first person swings the right arm sideways and up, towards the other, who holds the left
/// hand out.
struct Throwing {
  static constexpr double kSwing_s = 1.5, kSwingEnd_s = 1.8;
  double distance_m = 2.4;

  SceneOptions Options() const {
    SceneOptions scene;
    SceneObject ball = MakeBall(0.16, 0.4);
    const Eigen::Vector3d hand = RightHand((*this)(0.0)[0]);
    ball.body.position_m = hand + Eigen::Vector3d(0.03, 1.0 - 0.14, 0.0);
    SceneObject stand = ball;
    stand.name = "stand";
    stand.body = {};
    stand.body.kind = physics::BodyKind::kStatic;
    const double height_m = ball.body.position_m.y() - 0.081;
    stand.body.size_m = {0.1, height_m, 0.1};
    stand.body.position_m = ball.body.position_m;
    stand.body.position_m.y() = 0.5 * height_m;
    scene.objects = {stand, ball};
    GrabRule grab;
    grab.slower_m_s = 8.0;  // caught in flight
    scene.grabs = {grab};
    scene.throws = {ThrowRule{}};
    return scene;
  }
  std::vector<CapsulePose> operator()(double t) const {
    CapsulePose first = PersonOf(1.75, -0.5 * distance_m);
    first.right_lift_rad = 0.1 + 1.3 * Ease(t, kSwing_s, kSwingEnd_s);
    CapsulePose second = PersonOf(1.65, 0.5 * distance_m);
    second.left_lift_rad = 1.7;
    return {first, second};
  }
};

/// Largest depth of an overlap that counts as contact, metres.
inline constexpr double kOverlap_m = 0.005;  // by hand: "a few millimetres"

/// The position of an object, camera space, metres; fails the test if it does not exist.
inline Eigen::Vector3d PlaceOf(const tracker::Scene& scene, const std::string& name) {
  for (const tracker::SceneObjectState& object : scene.objects()) {
    if (object.name == name) return object.position_m;
  }
  ADD_FAILURE() << name << " is not there";
  return Eigen::Vector3d::Zero();
}

/// The ids of the people who hold an object, ascending; empty if it does not exist.
inline std::vector<int> HoldersOf(const tracker::Scene& scene, const std::string& name) {
  for (const tracker::SceneObjectState& object : scene.objects()) {
    if (object.name == name) return object.held_by;
  }
  return {};
}

}  // namespace ossa::tracker::test
