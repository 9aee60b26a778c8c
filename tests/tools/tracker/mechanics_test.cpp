#include <gtest/gtest.h>

#include "recon/body/standard_body.h"
#include "recon/normalise.h"
#include "recon/orientation.h"
#include "tools/tracker/mechanics_internal.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

TEST(Mechanics, AnUnseenFootStaysAtItsReconstruction) {
  // Two metres before the sensor, and the feet stretched out, which a hanging foot would not be.
  recon::Posture standing = recon::StandardPosture(recon::RigPose{});
  for (auto& p : standing.position_m) p.z() += 2.0;
  recon::JointArray<double> trust;
  trust.fill(1.0);
  for (const Joint foot : {Joint::kFootLeft, Joint::kFootRight}) trust[foot] = 0.0;
  Mechanics mechanics{MechanicsBuild{}};
  std::optional<physics::FilteredPosture> made;
  for (int i = 1; i <= 60; ++i) made = mechanics.Follow(standing, trust, std::nullopt, i / 30.0);
  ASSERT_TRUE(made.has_value());
  for (const Joint foot : {Joint::kFootLeft, Joint::kFootRight}) {
    // A quarter of the foot's length: the character is pulled, not placed.
    EXPECT_LT((made->posture[foot] - standing[foot]).norm(), 0.04) << recon::NameOf(foot);
  }
}

// The frame goes through the character like any other: nothing leaps to what was seen and back.
TEST(Mechanics, ContinuesWhenATimeRepeats) {
  recon::Posture standing = recon::StandardPosture(recon::RigPose{});
  for (auto& p : standing.position_m) p.z() += 2.0;
  recon::JointArray<double> trust;
  trust.fill(1.0);
  Mechanics mechanics{MechanicsBuild{}};
  for (int i = 0; i <= 30; ++i) mechanics.Follow(standing, trust, std::nullopt, i / 30.0);
  recon::Posture leaping = standing;
  leaping[Joint::kHandLeft].y() += 0.3;
  const auto made = mechanics.Follow(leaping, trust, std::nullopt, 1.0);
  ASSERT_TRUE(made.has_value());
  EXPECT_LT((made->posture[Joint::kHandLeft] - standing[Joint::kHandLeft]).norm(), 0.25);
}

// Physics on or off: bones are turned about themselves as the method has them.
TEST(Mechanics, KeepsTheTwistOfTheBones) {
  constexpr double kTwist_rad = 0.7;
  recon::SkeletonSequence sequence;
  recon::Posture standing = recon::StandardStance();
  for (auto& p : standing.position_m) p.z() += 2.0;
  const recon::JointOrientations plain = recon::ComputeOrientations(standing);
  for (int f = 0; f < 30; ++f) {
    recon::SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.time_s = f / 30.0;
    recon::BodyRecord& body = frame.bodies.emplace_back();
    for (size_t i = 0; i < recon::kJointCount; ++i) {
      auto& joint = body.joints[i].emplace();
      joint.position_m = standing.position_m[i];
      joint.orientation =
          plain[i] * Eigen::AngleAxisd(i == 0 ? 0.0 : kTwist_rad, Eigen::Vector3d::UnitY());
    }
  }
  recon::SkeletonSequence followed = sequence;
  FollowMechanically(followed, MechanicsBuild{}, {});
  for (const size_t bone : {6U, 10U, 14U, 15U, 18U, 19U}) {  // forearms, shins, feet
    const auto& before = *sequence.frames.back().bodies[0].joints[bone]->orientation;
    const auto& after = *followed.frames.back().bodies[0].joints[bone]->orientation;
    EXPECT_LT(before.angularDistance(after), 0.2) << recon::kJointNames[bone];
  }
}

/// The left shin of the character that followed somebody whose legs are `longer` after the first
/// frame, each frame by another `unsteady` more or less, over that of the first frame.
double ShinAfter(double longer, double unsteady) {
  recon::BoneLengths bones_m = recon::StandardBoneLengths();
  const auto shin = recon::Index(Joint::kAnkleLeft);
  recon::JointArray<double> trust;
  trust.fill(1.0);
  Mechanics mechanics{MechanicsBuild{}};
  std::optional<physics::FilteredPosture> made;
  for (int i = 0; i < 30; ++i) {
    const double now = i == 0 ? 1.0 : longer + (i % 2 == 0 ? unsteady : -unsteady);
    bones_m[shin] = now * recon::StandardBoneLengths()[shin];
    made = mechanics.Follow(recon::Retargeted(recon::StandardStance(), bones_m), trust,
                            std::nullopt, (i + 1) / 30.0);
  }
  return made ? recon::MeasureBoneLengths(made->posture)[shin] / recon::StandardBoneLengths()[shin]
              : 0;
}

TEST(Mechanics, CharacterGetsTheSettledBoneLengths) {
  EXPECT_NEAR(ShinAfter(1.1, 0.0), 1.1, 2e-3);
  EXPECT_NEAR(ShinAfter(1.1, 0.02), 1.0, 2e-3);   // they keep none
  EXPECT_NEAR(ShinAfter(1.005, 0.0), 1.0, 2e-3);  // hardly others
}

/// How high the left foot of somebody who stands with the feet at y = 0 is in the end, in metres,
/// when so high a floor is said to be there, one height after another, a second each.
double FootOn(std::initializer_list<double> floors_m) {
  const recon::Posture standing = recon::StandardStance();
  recon::JointArray<double> trust;
  trust.fill(1.0);
  Mechanics mechanics{MechanicsBuild{}};
  std::optional<physics::FilteredPosture> made;
  int frame = 0;
  for (const double floor_m : floors_m) {
    for (int i = 0; i < 30; ++i) {
      made = mechanics.Follow(standing, trust, Eigen::Vector4d(0.0, 1.0, 0.0, -floor_m),
                              ++frame / 30.0);
    }
  }
  return made ? made->posture[Joint::kFootLeft].y() - standing[Joint::kFootLeft].y() : -1.0;
}

TEST(Mechanics, TableTopIsNotTheFloor) {
  EXPECT_NEAR(FootOn({0.5}), 0.0, 0.02);  // a table's: the legs behind it are not lifted onto it
  EXPECT_GT(FootOn({0.08}), 0.05);        // a little too high for the feet: they stand on it
  EXPECT_NEAR(FootOn({0.0}), 0.0, 0.02);
  // From possible to impossible and back, with a margin between.
  EXPECT_GT(FootOn({0.14}), 0.1);
  EXPECT_NEAR(FootOn({0.5, 0.14}), 0.0, 0.02);
  EXPECT_GT(FootOn({0.5, 0.08}), 0.05);
}

}  // namespace
}  // namespace ossa::tracker
