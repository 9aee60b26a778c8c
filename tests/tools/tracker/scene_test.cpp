// People in one mechanical world with the things of a scene: skeletons in, what they do with them.
#include "tools/tracker/scene.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <optional>
#include <random>
#include <sstream>

#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_jsonl.h"
#include "tests/support/places.h"
#include "tests/tools/tracker/played_scenes.h"
#include "tools/tracker/scene_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::CapsulePose;
using test::Lifting;
using test::Play;
using test::Seen;
using test::Throwing;

constexpr double kOverlap_m = 0.005;  // "a few millimetres"

Vector3d PlaceOf(const Scene& scene, const std::string& name) {
  for (const SceneObjectState& object : scene.objects()) {
    if (object.name == name) return object.position_m;
  }
  ADD_FAILURE() << name << " is not there";
  return Vector3d::Zero();
}

std::vector<int> HoldersOf(const Scene& scene, const std::string& name) {
  for (const SceneObjectState& object : scene.objects()) {
    if (object.name == name) return object.held_by;
  }
  return {};
}

class LiftingTogether : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(LiftingTogether, PutsTheBoxWhereTheHandsAre) {
  Lifting lifting;
  lifting.first_height_m = GetParam().first;
  lifting.second_height_m = GetParam().second;
  Scene scene(lifting.Options());
  Vector3d before = Vector3d::Zero();
  double worst_hold_m = 0.0, distance_m = -1.0;
  const auto hands_y_m = [&](double t) {
    const auto people = lifting(t);
    return 0.5 * (test::RightHand(people[0]) + test::LeftHand(people[1])).y();
  };
  const Seen seen =
      Play(scene, lifting, 5.0, [&](double t, const recon::SkeletonFrame& frame, Scene& played) {
        if (t < 2.4) {
          if (t > 0.5) before = PlaceOf(played, "box");
          return;
        }
        // The box stays as far from the hand that took it as it was.
        const auto& hand = frame.bodies[0].joints[recon::Index(Joint::kHandRight)]->position_m;
        const double now_m = (PlaceOf(played, "box") - hand).norm();
        if (distance_m < 0.0) distance_m = now_m;
        worst_hold_m = std::max(worst_hold_m, std::abs(now_m - distance_m));
      });
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
  const double lifted_m = hands_y_m(5.0) - hands_y_m(2.4);
  EXPECT_GT(lifted_m, 0.25);
  EXPECT_NEAR(PlaceOf(scene, "box").y() - before.y(), lifted_m, 0.02);
  EXPECT_LT(worst_hold_m, 0.02);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
  EXPECT_TRUE(seen.is_finite);
}

INSTANTIATE_TEST_SUITE_P(PeopleOfAllSizes, LiftingTogether,
                         testing::Values(std::pair(1.75, 1.75), std::pair(1.9, 1.6),
                                         std::pair(1.2, 1.75)));

TEST(SceneRules, WhoIsAloneDoesNotLiftWhatTakesTwo) {
  Lifting lifting;
  lifting.hands = 1;
  Scene scene(lifting.Options());
  const Seen seen = Play(scene, lifting, 5.0);
  EXPECT_TRUE(HoldersOf(scene, "box").empty());
  EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, 1), 0);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

// What takes two people by one rule is held by one of them by another.
TEST(SceneRules, OfTwoThatNameOneThingNeitherUndoesTheOther) {
  Lifting lifting;
  lifting.hands = 1;
  SceneOptions options = lifting.Options();
  options.grabs.insert(options.grabs.begin(), GrabRule{});
  for (const bool turned : {false, true}) {
    if (turned) std::swap(options.grabs.front(), options.grabs.back());
    Scene scene(options);
    const Seen seen = Play(scene, lifting, 5.0);
    EXPECT_EQ(HoldersOf(scene, "box"), std::vector<int>{1});
    EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, 1), 1);
    EXPECT_EQ(seen.Count(SceneEvent::Kind::kReleased, 1), 0);
  }
}

TEST(SceneRules, WhoMovesTheHandAwayLetsGoAndTheBoxFalls) {
  Lifting lifting;
  lifting.apart_s = 5.0;
  Scene scene(lifting.Options());
  const Seen seen = Play(scene, lifting, 7.0);
  EXPECT_TRUE(HoldersOf(scene, "box").empty());
  EXPECT_GT(seen.Count(SceneEvent::Kind::kReleased, 1), 0);
  EXPECT_LT(PlaceOf(scene, "box").y(), -1.0 + test::kTable_m + 0.2);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

TEST(SceneRules, ThrownByOneCaughtByTheOther) {
  const Throwing throwing;
  Scene scene(throwing.Options());
  double hand_m_s = 0.0, ball_m_s = 0.0;
  Vector3d hand_before = Vector3d::Zero();
  const Seen seen =
      Play(scene, throwing, 4.0, [&](double, const recon::SkeletonFrame& frame, Scene& played) {
        const Vector3d hand = frame.bodies[0].joints[recon::Index(Joint::kHandRight)]->position_m;
        if (frame.frame > 5) hand_m_s = std::max(hand_m_s, 30.0 * (hand - hand_before).norm());
        hand_before = hand;
        for (const SceneEvent& event : played.events()) {
          if (event.kind == SceneEvent::Kind::kThrown) {
            ball_m_s = played.objects().back().velocity_m_s.norm();
          }
        }
      });
  EXPECT_EQ(seen.Count(SceneEvent::Kind::kThrown, 1), 1);
  // The ball leaves as fast as the hand was; less by what a speed loses that is smoothed over a
  // frame.
  EXPECT_GT(ball_m_s, 0.8 * hand_m_s);
  EXPECT_LT(ball_m_s, 1.05 * hand_m_s);
  EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, 2), 1);
  EXPECT_EQ(HoldersOf(scene, "ball"), (std::vector<int>{2}));
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

/// How fast the ball leaves a hand that is tracked to so much, against the hand's fastest.
double SpeedOfThrow(double noise_m, unsigned seed) {
  const Throwing throwing;
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_m);
  Scene scene(throwing.Options());
  double hand_m_s = 0.0, ball_m_s = 0.0;
  std::optional<Vector3d> before;
  for (int f = 0; f < 75 && ball_m_s == 0.0; ++f) {
    recon::SkeletonFrame frame = test::SkeletonsOf(throwing(f / 30.0), f);
    Vector3d& hand = frame.bodies[0].joints[recon::Index(Joint::kHandRight)]->position_m;
    if (before) hand_m_s = std::max(hand_m_s, 30.0 * (hand - *before).norm());
    before = hand;
    hand += Vector3d(noise(random), noise(random), noise(random));
    scene.Play(frame);
    for (const SceneEvent& event : scene.events()) {
      if (event.kind != SceneEvent::Kind::kThrown) continue;
      ball_m_s = scene.objects().back().velocity_m_s.norm();
    }
  }
  return ball_m_s / hand_m_s;
}

// Two frames alone would make 3 cm of noise 1.3 m/s a coordinate.
TEST(SceneRules, WhatIsThrownLeavesAsFastAsTheHandWasThoughItIsTrackedRoughly) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const double share = SpeedOfThrow(0.03, seed);
    EXPECT_GT(share, 0.6) << seed;
    EXPECT_LT(share, 1.25) << seed;
  }
}

/// Frames in which a ball that flies at somebody's head strikes head or trunk.
int CountHits(const std::optional<DodgeRule>& dodge, double aside_m) {
  SceneOptions options;
  SceneObject ball = test::MakeBall(0.2, 0.2);
  ball.origin = SceneObject::Origin::kPerson;
  ball.body.position_m = {aside_m, 1.6, 3.0};
  ball.body.velocity_m_s = {0.0, 0.5 * 9.81 * 0.5, -3.0 / 0.5};  // at the head in half a second
  ball.after_s = 0.5;
  options.objects = {ball};
  options.dodge = dodge;
  Scene scene(options);
  int hits = 0;
  const auto standing = [](double) { return std::vector<CapsulePose>{test::PersonOf(1.75, 0.0)}; };
  Play(scene, standing, 3.0, [&](double, const recon::SkeletonFrame&, Scene& played) {
    for (const physics::Strike& strike : played.world().Contacts().struck) {
      hits += strike.bone <= recon::Index(Joint::kHead) ? 1 : 0;
    }
  });
  return hits;
}

TEST(SceneRules, WhoDodgesIsNotHitByWhatFliesAtTheHead) {
  for (const double aside_m : {0.0, 0.08, -0.08}) {
    EXPECT_GT(CountHits(std::nullopt, aside_m), 0) << aside_m;
    EXPECT_EQ(CountHits(DodgeRule{.lean = true, .cover = false}, aside_m), 0) << aside_m;
    EXPECT_EQ(CountHits(DodgeRule{}, aside_m), 0) << aside_m;
  }
}

TEST(Scene, GoesOnWhenPeopleLeaveAndWhatTheyHoldFalls) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  const auto leaving = [&](double t) {
    auto people = lifting(t);
    if (t > 5.0) people.clear();
    return people;
  };
  const Seen seen = Play(scene, leaving, 7.0);
  EXPECT_EQ(scene.CharacterOf(1), std::nullopt);
  EXPECT_TRUE(scene.world().Characters().empty());
  EXPECT_LT(PlaceOf(scene, "box").y(), -1.0 + test::kTable_m + 0.2);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

TEST(Scene, WhoseBonesAreKnownBetterHoldsOnToWhatTheyHold) {
  Lifting lifting, taller;
  taller.first_height_m = 1.8;  // 3 % more: another character
  Scene scene(lifting.Options());
  std::optional<int> character;
  const auto people = [&](double t) { return t < 4.3 ? lifting(t) : taller(t); };
  const Seen seen =
      Play(scene, people, 5.5, [&](double t, const recon::SkeletonFrame&, Scene& played) {
        if (t < 4.3) character = played.CharacterOf(1);
      });
  EXPECT_NE(scene.CharacterOf(1), character);
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
  for (const int body : {1, 2}) {
    EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, body), 1) << body;
    EXPECT_EQ(seen.Count(SceneEvent::Kind::kReleased, body), 0) << body;
  }
}

TEST(Scene, CompletesPeopleOfWhomJointsAreMissing) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  for (int f = 0; f < 120; ++f) {
    recon::SkeletonFrame frame = test::SkeletonsOf(lifting(f / 30.0), f);
    for (auto& joint : frame.bodies[0].joints) {
      const auto j = static_cast<size_t>(&joint - frame.bodies[0].joints.data());
      if (j == 0 || j >= 12 || (f % 3 == 0 && j == 9)) joint.reset();  // hips, legs; an elbow
    }
    if (f % 7 == 0) frame.bodies[1].joints = {};  // nothing is known of the other
    scene.Play(frame);
    for (const auto& joint : frame.bodies[0].joints) {
      ASSERT_TRUE(joint.has_value());
      ASSERT_TRUE(joint->position_m.allFinite());
      ASSERT_LT(joint->position_m.norm(), 4.0);
    }
  }
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
}

TEST(Scene, BeginsAnewWhereTimeRunsBack) {
  const Lifting lifting;
  Scene scene(lifting.Options()), fresh(lifting.Options());
  Play(scene, lifting, 4.0);
  Play(scene, lifting, 1.0);
  Play(fresh, lifting, 1.0);
  EXPECT_EQ(PlaceOf(scene, "box"), PlaceOf(fresh, "box"));
}

TEST(Scene, GoesOnWhereTimesRepeatOrRunBackByMilliseconds) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  for (int f = 0; f < 120; ++f) {
    recon::SkeletonFrame frame = test::SkeletonsOf(lifting(f / 30.0), f);
    if (f % 6 == 5) frame.time_s -= 1 / 30.0 + (f % 12 == 5 ? 0.002 : 0.0);
    scene.Play(frame);
  }
  EXPECT_EQ(HoldersOf(scene, "box"), (std::vector<int>{1, 2}));
  EXPECT_TRUE(PlaceOf(scene, "box").allFinite());
}

// After a gap somebody is put elsewhere, and goes on holding what they hold.
TEST(HandMemory, ForgetsHowItMovedAndNotHowItHolds) {
  HandMemory hand;
  hand.held_at_m = 0.07;
  hand.taken_by.near_m = 0.3;
  hand.away_s = 0.2;
  hand.made_m = Vector3d::UnitY();
  for (int f = 0; f < 4; ++f) hand.See(f / 30.0, Vector3d(0.1 * f, 0, 0));
  ASSERT_GT(hand.SteadyVelocity_m_s().x(), 2.9);
  hand.ForgetMotion();
  EXPECT_EQ(hand.held_at_m, 0.07);
  EXPECT_EQ(hand.taken_by.near_m, 0.3);
  EXPECT_EQ(hand.away_s, 0.0);
  EXPECT_FALSE(hand.made_m.has_value());
  EXPECT_EQ(hand.seen_velocity_m_s, Vector3d::Zero());
  hand.See(9.0, Vector3d(5, 0, 0));
  EXPECT_EQ(hand.seen_velocity_m_s, Vector3d::Zero());
}

// Things would wait for it for ever.
TEST(Scene, TakesNoFloorThatIsNone) {
  SceneOptions options = Lifting().Options();
  options.floor = test::Ground();
  EXPECT_NO_THROW(options.Check());
  options.floor->y() = 0.0;
  EXPECT_THROW(options.Check(), std::invalid_argument);
  options.floor = Eigen::Vector4d(0.0, 1.0, 0.0, std::nan(""));
  EXPECT_THROW(options.Check(), std::invalid_argument);
}

TEST(Scene, WaitsForAFloor) {
  Scene scene(Lifting{}.Options());
  recon::SkeletonFrame frame = test::SkeletonsOf(Lifting{}(0.0), 0);
  frame.floor.reset();
  for (int f = 0; f < 30; ++f) {
    frame.time_s = f / 30.0;
    scene.Play(frame);
  }
  EXPECT_FALSE(scene.has_floor());
  EXPECT_TRUE(scene.objects().empty());
}

TEST(Scene, PutsThingsWhereSomebodyStands) {
  SceneOptions options;
  SceneObject ball;
  ball.name = "ball";
  ball.body.shape = physics::Shape::kBall;
  ball.body.size_m.setConstant(0.1);
  ball.body.kind = physics::BodyKind::kStatic;
  ball.origin = SceneObject::Origin::kPerson;
  ball.person = 2;
  ball.body.position_m = {0.3, 1.0, 0.5};  // to the left, in front
  options.objects = {ball};
  Scene scene(options);
  Play(scene, Lifting{}, 1.0);
  // Who faces the camera has their left at lower x, and before them is nearer.
  const recon::Posture second = tests::ComputeJoints(Lifting{}(0.0)[1]);
  const Vector3d wanted = second[Joint::kHipCenter] + Vector3d(-0.3, 0.0, -0.5);
  EXPECT_NEAR(PlaceOf(scene, "ball").x(), wanted.x(), 0.03);
  EXPECT_NEAR(PlaceOf(scene, "ball").y(), 0.0, 0.001);
  EXPECT_NEAR(PlaceOf(scene, "ball").z(), wanted.z(), 0.05);
}

TEST(Scene, WritesItsObjectsWhichReadersPassOver) {
  const Lifting lifting;
  Scene scene(lifting.Options());
  std::string line;
  Play(scene, lifting, 0.5, [&](double, const recon::SkeletonFrame& frame, Scene&) {
    line = recon::SkeletonJsonLine(frame);
  });
  EXPECT_NE(line.find(R"("objects":[{"name":"table","p":[)"), std::string::npos) << line;
  std::istringstream stream(line);
  recon::SkeletonJsonlReader reader(stream, "played");
  recon::SkeletonFrame read;
  ASSERT_TRUE(reader.Next(read));
  EXPECT_EQ(read.bodies.size(), 2U);
}

/// A recording with its feet on y = 0 and its hips, at first, at a place of the floor; of another
/// size than it was, and without some joints.
recon::SkeletonSequence Staged(recon::SkeletonSequence recording, const Vector3d& place_m,
                               double scale, std::initializer_list<Joint> missing) {
  double lowest_m = 10.0;
  std::optional<Vector3d> hips;
  for (auto& frame : recording.frames) {
    for (auto& joint : frame.bodies.at(0).joints) {
      if (!joint) continue;
      joint->position_m *= scale;
      if (!hips) hips = joint->position_m;
      lowest_m = std::min(lowest_m, joint->position_m.y());
    }
  }
  const Vector3d by_m = place_m - Vector3d(hips->x(), lowest_m, hips->z());
  for (auto& frame : recording.frames) {
    for (auto& joint : frame.bodies[0].joints) {
      if (joint) joint->position_m += by_m;
    }
    for (const Joint joint : missing) frame.bodies[0].joints[recon::Index(joint)].reset();
  }
  return recording;
}

// Before a Kinect v2: somebody squats, whose hands the recording lacks, and a patient raises both
// arms from the hips.
TEST(RealScene, PatientsOfOtherSizesWithJointsMissingShareAWorldWithThings) {
  const auto real = ossa::test::SharedFolder() / "real";
  if (!std::filesystem::exists(real)) GTEST_SKIP() << real << " is not there";
  const auto first =
      Staged(recon::ReadSkeletons(
                 real / "uiprmd_kinect_vicon/raw_e05.tar.gz#Kinect_Positions/m01_s10_e05"),
             {-0.7, 0.0, 2.5}, 1.0, {});
  const auto second = Staged(
      recon::ReadSkeletons(real / "keraal_kinect_vicon/pairs/G3-Kinect-CTK-P1T1-Unknown-C-0.txt"),
      {0.7, 0.0, 2.5}, 0.75, {Joint::kFootLeft, Joint::kAnkleLeft, Joint::kHandLeft});
  SceneOptions options;
  options.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  for (const int person : {1, 2}) {
    SceneObject box;
    box.name = "box " + std::to_string(person);
    box.body.size_m = person == 1 ? Vector3d(0.9, 0.12, 0.12) : Vector3d(0.26, 0.1, 0.1);
    box.body.mass_kg = 0.3;
    box.origin = SceneObject::Origin::kPerson;
    box.person = person;
    box.body.position_m = person == 1 ? Vector3d(0.0, 1.06, 0.4) : Vector3d(0.05, 0.43, 0.35);
    SceneObject table = box;
    table.name = "table " + std::to_string(person);
    table.body.kind = physics::BodyKind::kStatic;
    const double height_m = box.body.position_m.y() - 0.5 * box.body.size_m.y() - 0.001;
    table.body.size_m = {0.1, height_m, 0.1};
    table.body.position_m.y() = 0.5 * height_m;
    options.objects.push_back(box);
    options.objects.push_back(table);
  }
  options.grabs = {GrabRule{}};
  options.releases = {ReleaseRule{}};
  options.dodge = DodgeRule{};
  Scene scene(options);
  Seen seen;
  const size_t frames = std::min<size_t>(300, std::min(first.frames.size(), second.frames.size()));
  for (size_t f = 0; f < frames; ++f) {
    recon::SkeletonFrame frame;
    frame.time_s = static_cast<double>(f) / 30.0;
    frame.bodies = {first.frames[f].bodies[0], second.frames[f].bodies[0]};
    frame.bodies[0].id = 1;
    frame.bodies[1].id = 2;
    if (f % 40 == 39) frame.bodies.pop_back();  // lost for a frame
    scene.Play(frame);
    seen.Look(scene);
    for (const recon::BodyRecord& body : frame.bodies) {
      for (const auto& joint : body.joints) ASSERT_TRUE(joint && joint->position_m.allFinite());
    }
    for (const int character : scene.world().Characters()) {
      ASSERT_EQ(scene.world().StateOf(character).rescued, 0) << f;
    }
  }
  EXPECT_GT(frames, 60U);
  EXPECT_EQ(scene.objects().size(), 4U);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
  EXPECT_TRUE(seen.is_finite);
}

/// A flat box just above the hands of somebody as they sit at first.
SceneOptions BoxAtHandsOf(const recon::BodyRecord& body) {
  const Vector3d left = body.joints[recon::Index(Joint::kHandLeft)].value().position_m;
  const Vector3d right = body.joints[recon::Index(Joint::kHandRight)].value().position_m;
  const Vector3d across = left - right;
  SceneObject box;
  box.name = "box";
  box.body.size_m = {across.norm() - 0.06, 0.06, 0.1};
  box.body.mass_kg = 0.5;
  box.body.position_m = 0.5 * (left + right) + Vector3d(0.0, 0.1, 0.0);
  box.body.orientation = Eigen::AngleAxisd(std::atan2(-across.z(), across.x()), Vector3d::UnitY());
  SceneOptions scene;
  scene.floor = Eigen::Vector4d(0.0, 1.0, 0.0, 0.0);
  scene.objects = {box};
  GrabRule grab;
  grab.hands = 2;
  scene.grabs = {grab};
  scene.releases = {ReleaseRule{}};
  return scene;
}

// A patient of KERAAL, who first waits for a box at the hands, raises both arms and spreads them.
TEST(RealScene, HandsOfKeraalTakeABoxUpAndLetGoOfItWhereTheySpread) {
  const auto keraal = ossa::test::SharedFolder() / "real/keraal_kinect_vicon/pairs";
  if (!std::filesystem::exists(keraal)) GTEST_SKIP() << keraal << " is not there";
  const auto patient = Staged(recon::ReadSkeletons(keraal / "G3-Kinect-CTK-P1T1-Unknown-C-0.txt"),
                              {0.0, 0.0, 2.5}, 1.0, {});
  const recon::BodyRecord& first = patient.frames.at(0).bodies.at(0);
  const SceneOptions options = BoxAtHandsOf(first);
  const double start_m = options.objects.back().body.position_m.y();
  constexpr size_t kWaits = 20, kFrames = 90;
  ASSERT_GT(patient.frames.size(), kFrames - kWaits);
  Scene scene(options);
  Seen seen;
  double highest_m = 0.0;
  for (size_t f = 0; f < kFrames; ++f) {
    recon::SkeletonFrame frame = patient.frames[f < kWaits ? 0 : f - kWaits];
    frame.time_s = static_cast<double>(f) / 30.0;
    scene.Play(frame);
    seen.Look(scene);
    if (HoldersOf(scene, "box").empty()) continue;
    highest_m = std::max(highest_m, PlaceOf(scene, "box").y());
  }
  EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, first.id), 2);
  EXPECT_GT(seen.Count(SceneEvent::Kind::kReleased, first.id), 0);
  EXPECT_GT(highest_m, start_m + 0.3);
  EXPECT_LT(PlaceOf(scene, "box").y(), start_m);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
  EXPECT_TRUE(seen.is_finite);
}

}  // namespace
}  // namespace ossa::tracker
