#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "recon/methods/prepared_posture_internal.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

// The database query must have the hand where it is, whatever the arm's length and the guess for
// the hidden elbow.
TEST(Person, HiddenArmKeepsTheReachOfItsHand) {
  for (const double scale : {0.6, 1.0, 1.3}) {
    Person person;
    const Posture before = test::Gesture(0.2, 0.2, 0.1), now = test::Gesture(1.6, 0.2, 0.8);
    person.Prepare({test::AllTracked(test::InFrontOfCamera(before, scale)), 0.0, nullptr});
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(now, scale));
    seen.state[5] = seen.state[6] = TrackingState::kNotTracked;  // elbow and wrist
    const PreparedPosture prepared = person.Prepare({seen, 1.0 / 30, nullptr});
    // The person is the standard one scaled: bones are known from the first frame exactly.
    EXPECT_LT((prepared.normalised.position_m[7] - now.position_m[7]).norm(), 1e-3) << scale;
    EXPECT_EQ(prepared.reliability[5], 0.0);
  }
}

// Guessed hips and shoulders tell the heading if there are no better ones.
TEST(Person, TakesTheHeadingFromGuessesIfNothingIsReliable) {
  const double yaw_rad = 2.2;
  TrackedPosture seen =
      test::AllTracked(Placed(test::Gesture(0.2, 0.3, 0.1), {{0.1, 0.2, 2.5}, yaw_rad}));
  seen.state.fill(TrackingState::kInferred);
  EXPECT_NEAR(Person().Prepare({seen, 0.0, nullptr}).placement.yaw_rad, yaw_rad, 1e-9);
}

// What is not seen of a new person is completed alike whichever way they face.
TEST(Person, FirstFrameIsCompletedInThePersonsHeading) {
  constexpr std::array kUnseen = {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft,
                                  Joint::kHipLeft,   Joint::kHipRight,  Joint::kHipCenter};
  const Posture facing = test::InFrontOfCamera(test::Gesture(0.2, 0.2, 0.1));
  const auto completed = [&](double turn_rad) {
    TrackedPosture seen = test::AllTracked(facing);
    const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitY());
    for (Eigen::Vector3d& p : seen.posture.position_m) {
      p = facing[Joint::kHipCenter] + turn * (p - facing[Joint::kHipCenter]);
    }
    for (const Joint joint : kUnseen) seen.state[Index(joint)] = TrackingState::kNotTracked;
    Posture whole = Person().Prepare({seen, 0.0, nullptr}).in_camera;
    for (Eigen::Vector3d& p : whole.position_m) {
      p = facing[Joint::kHipCenter] + turn.inverse() * (p - facing[Joint::kHipCenter]);
    }
    return whole;
  };
  const Posture wanted = completed(0.0);
  for (const double turn_rad : {0.5, 1.5, 2.5, 3.14, 4.5, 5.5}) {
    const Posture whole = completed(turn_rad);
    for (const Joint joint : kUnseen) {
      EXPECT_LT((whole[joint] - wanted[joint]).norm(), 0.02) << NameOf(joint) << " at " << turn_rad;
    }
  }
}

/// The standing person with the hips that far apart over the standard ones.
Posture WithHips(double factor) {
  Posture posture = test::InFrontOfCamera(test::Gesture(0.2, 0.2, 0.1));
  for (const size_t hip : {size_t{12}, size_t{16}}) {
    const Eigen::Vector3d moved =
        (factor - 1.0) * (posture.position_m[hip] - posture.position_m[0]);
    for (size_t i = hip; i < hip + 4; ++i) posture.position_m[i] += moved;
  }
  return posture;
}

// A person who enters sideways: in the first frame the hips coincide.
TEST(BodySize, CorrectsBonesThatDifferFromTheFirstFrame) {
  BodySize size({.as_measured = true});
  JointWeights all;
  all.fill(1.0);
  size.Observe(WithHips(0.5), all);
  const double hip = StandardBoneLengths()[12];
  EXPECT_NEAR(size.lengths_m()[12], 0.5 * hip, 1e-9);
  for (int f = 0; f < 150; ++f) {
    const double before = size.lengths_m()[12];
    size.Observe(WithHips(f % 3 == 0 ? 0.5 : 1.0), all);
    EXPECT_LT(std::abs(size.lengths_m()[12] - before), 0.06 * hip) << f;  // grows, does not jump
  }
  EXPECT_NEAR(size.lengths_m()[12], hip, 0.03 * hip);
  EXPECT_NEAR(size.lengths_m()[16], hip, 0.03 * hip);
}

// With noisy bones the first frame's lengths are kept, to the bit.
TEST(BodySize, KeepsConsistentBones) {
  BodySize size({.as_measured = true});
  JointWeights all;
  all.fill(1.0);
  size.Observe(WithHips(1.0), all);
  const BoneLengths first = size.lengths_m();
  std::mt19937_64 rng(3);
  for (int f = 0; f < 1000; ++f) {
    Posture seen = WithHips(1.0);
    test::AddNoise(seen, 0.004, rng);
    size.Observe(seen, all);
  }
  EXPECT_EQ(size.lengths_m(), first);
}

// The mean of the first three frames' estimates, whatever the distances between joints; then
// constant.
TEST(BodySize, SettlesInThreeFramesWithNetworkEstimates) {
  BodySize size({.as_measured = true});
  JointWeights all;
  all.fill(1.0);
  const Posture seen = WithHips(1.5);
  const size_t hip = 12;
  const auto judged = [&](double factor) {
    BoneLengths lengths_m = StandardBoneLengths();
    lengths_m[hip] *= factor;
    size.Observe(seen, all, 0.0, lengths_m);
    return size.lengths_m()[hip] / StandardBoneLengths()[hip];
  };
  EXPECT_NEAR(judged(1.10), 1.10, 1e-9);
  EXPECT_NEAR(judged(1.20), 1.15, 1e-9);
  const double settled = judged(1.15);
  EXPECT_NEAR(settled, 1.15, 1e-9);
  for (int i = 0; i < 80; ++i) EXPECT_EQ(judged(1.18), settled) << i;
  // What is typically other is taken after 3.5 seconds, nor is a frame without judgement a change.
  size.Observe(seen, all, 0.0);
  EXPECT_EQ(size.lengths_m()[hip] / StandardBoneLengths()[hip], settled);
  for (int i = 0; i < 200; ++i) judged(1.40);
  EXPECT_GT(judged(1.40), 1.20);
  BodySize absurd({.as_measured = true});
  BoneLengths long_m;
  long_m.fill(1.9);  // a hand, too
  absurd.Observe(seen, all, 0.0, long_m);
  EXPECT_LT(absurd.lengths_m()[7], 3.0 * StandardBoneLengths()[7]);
}

// A bone whose estimate changes is adapted; its neighbours are kept, to the bit.
TEST(BodySize, ChangesOnlyWrongBonesOfNetworkEstimates) {
  BodySize size({.as_measured = true});
  JointWeights all;
  all.fill(1.0);
  const Posture seen = WithHips(1.0);
  const size_t hip = 12, knee = 13;
  const auto judge = [&](double hip_factor, double knee_factor) {
    BoneLengths lengths_m = StandardBoneLengths();
    lengths_m[hip] *= hip_factor;
    lengths_m[knee] *= knee_factor;
    size.Observe(seen, all, 0.0, lengths_m);
  };
  for (int i = 0; i < 10; ++i) judge(1.0, 1.0);
  const BoneLengths settled_m = size.lengths_m();
  for (int i = 0; i < 200; ++i) judge(1.3, 1.02);
  EXPECT_GT(size.lengths_m()[hip], 1.1 * settled_m[hip]);
  EXPECT_EQ(size.lengths_m()[knee], settled_m[knee]);
}

TEST(BodySize, AdaptsToAnotherSizeAfterASecond) {
  BodySize size({.as_measured = true});
  JointWeights all;
  all.fill(1.0);
  for (int f = 0; f < 60; ++f) size.Observe(WithHips(1.0), all);
  const Posture child = test::InFrontOfCamera(test::Gesture(0.2, 0.2, 0.1), 0.6);
  for (int f = 0; f < 30; ++f) {
    EXPECT_NEAR(size.scale(), 1.0, 1e-6) << f;
    size.Observe(child, all);
  }
  EXPECT_NEAR(size.scale(), 0.6, 1e-6);
  EXPECT_NEAR(size.lengths_m()[13], 0.6 * StandardBoneLengths()[13], 1e-6);
}

/// Somebody with long upper arms, who stands or raises them.
TrackedPosture LongArmed(double lift_rad) {
  BoneLengths lengths = StandardBoneLengths();
  for (const Joint elbow : {Joint::kElbowLeft, Joint::kElbowRight}) lengths[Index(elbow)] *= 1.35;
  return test::AllTracked(
      Placed(Retargeted(test::Gesture(lift_rad, lift_rad, 0.1), lengths), {{0.1, 0.2, 2.5}, 3.1}));
}

// Reference lengths belong to the person: those from before a gap remain valid.
TEST(Person, KeepsReferenceLengthsOverAGap) {
  Person person;
  for (int f = 0; f < 10; ++f) person.Prepare({LongArmed(0.2), f / 30.0, nullptr});
  const auto after = person.Prepare({LongArmed(1.2), 2.0, nullptr});  // no reference posture
  ASSERT_TRUE(after.restarted);
  EXPECT_GT(after.terms.kinematics[Index(Joint::kElbowLeft)], 0.98);
}

TEST(Person, IsForgottenAfterAGapOrBackwardsTimeButNotARepeatedTime) {
  Person person;
  const TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Gesture(0.2, 0.2, 0.1)));
  struct Case {
    double time_s;
    bool restarted;
    double dt_s;
  };
  constexpr double kUsual_s = 1.0 / 30.0;
  for (const Case& at :
       {Case{5.0, true, kUsual_s}, Case{5.0, false, kUsual_s}, Case{5.25, false, 0.25},
        Case{5.25, false, 0.25}, Case{5.248, false, 0.25}, Case{5.246, false, 0.25},
        // Back by little each time, but by 6 ms from the latest.
        Case{5.244, true, kUsual_s}, Case{4.0, true, kUsual_s}, Case{4.5, false, 0.5},
        Case{5.125, true, kUsual_s}, Case{std::nan(""), true, kUsual_s},
        Case{5.25, true, kUsual_s}}) {
    const PreparedPosture prepared = person.Prepare({seen, at.time_s, nullptr});
    EXPECT_EQ(prepared.restarted, at.restarted) << at.time_s;
    EXPECT_DOUBLE_EQ(prepared.dt_s, at.dt_s) << at.time_s;
  }
}

TEST(Person, UsesTheSensorsTrunkBones) {
  Person person;
  Posture posture = test::InFrontOfCamera(test::Gesture(0.2, 0.2, 0.1));
  const Eigen::Vector3d up = posture[Joint::kSpine] - posture[Joint::kHipCenter];
  posture[Joint::kSpine] += 0.1 * up.normalized();
  const PreparedPosture prepared = person.Prepare({test::AllTracked(posture), 0.0, nullptr});
  const Posture back = person.InCamera(prepared.normalised, prepared);
  // There and back is the same posture, not one with a spine of the standard length.
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT((back.position_m[i] - posture.position_m[i]).norm(), 1e-3) << kJointNames[i];
  }
}

}  // namespace
}  // namespace ossa::recon
