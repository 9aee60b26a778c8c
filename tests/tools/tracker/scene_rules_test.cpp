// Rules of a scene: grabbing, releasing, throwing and dodging.
#include "tools/tracker/scene.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "tests/tools/tracker/played_scenes.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using test::CapsulePose;
using test::HoldersOf;
using test::kOverlap_m;
using test::Lifting;
using test::PlaceOf;
using test::Play;
using test::Seen;
using test::Throwing;

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

TEST(SceneRules, OnePersonDoesNotLiftAnObjectForTwo) {
  Lifting lifting;
  lifting.hands = 1;
  Scene scene(lifting.Options());
  const Seen seen = Play(scene, lifting, 5.0);
  EXPECT_TRUE(HoldersOf(scene, "box").empty());
  EXPECT_EQ(seen.Count(SceneEvent::Kind::kGrabbed, 1), 0);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

// What takes two people by one rule is held by one of them by another.
TEST(SceneRules, TwoRulesForOneObjectDoNotUndoEachOther) {
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

TEST(SceneRules, MovingTheHandAwayReleasesTheBox) {
  Lifting lifting;
  lifting.apart_s = 5.0;
  Scene scene(lifting.Options());
  const Seen seen = Play(scene, lifting, 7.0);
  EXPECT_TRUE(HoldersOf(scene, "box").empty());
  EXPECT_GT(seen.Count(SceneEvent::Kind::kReleased, 1), 0);
  EXPECT_LT(PlaceOf(scene, "box").y(), -1.0 + test::kTable_m + 0.2);
  EXPECT_LT(seen.deepest_m, kOverlap_m);
}

TEST(SceneRules, ObjectThrownByOneIsCaughtByTheOther) {
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
TEST(SceneRules, AThrownObjectHasTheSpeedOfTheHandDespiteTrackingNoise) {
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

TEST(SceneRules, DodgingAvoidsAnObjectFlyingAtTheHead) {
  for (const double aside_m : {0.0, 0.08, -0.08}) {
    EXPECT_GT(CountHits(std::nullopt, aside_m), 0) << aside_m;
    EXPECT_EQ(CountHits(DodgeRule{.lean = true, .cover = false}, aside_m), 0) << aside_m;
    EXPECT_EQ(CountHits(DodgeRule{}, aside_m), 0) << aside_m;
  }
}

}  // namespace
}  // namespace ossa::tracker
