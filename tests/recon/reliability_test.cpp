#include "recon/reliability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr size_t kHandLeft = 7;

TEST(Reliability, SteadyCompletePostureGivesOne) {
  ReliabilityEstimator estimator;
  const Posture seen = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
  Reliability r;
  for (int f = 0; f < 10; ++f) r = estimator.Step(test::AllTracked(seen), nullptr);
  for (const double rate : r.rate) EXPECT_NEAR(rate, 1.0, 1e-9);
}

TEST(Reliability, VibratingJointFalls) {  // eqs. 1-4: 180 degree turns exceed the roof
  ReliabilityEstimator estimator;
  Reliability r;
  for (int f = 0; f < 10; ++f) {
    Posture seen = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
    seen.position_m[kHandLeft].z() += f % 2 == 0 ? 0.03 : -0.03;
    r = estimator.Step(test::AllTracked(seen), nullptr);
  }
  EXPECT_EQ(r.behaviour[kHandLeft], 0.0);
  EXPECT_LT(r.rate[kHandLeft], 0.1);
  EXPECT_NEAR(r.behaviour[11], 1.0, 1e-12);
}

// Eqs. 1-4 in numbers: steps of 5 cm that turn by 120, 100 and 110 degrees are a mean turn of 110,
// twenty of the 45 degrees from the floor to the roof.
TEST(Reliability, RotationsOf110DegreesGiveFiveNinths) {
  ReliabilityEstimator estimator;
  Posture seen = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
  Reliability r = estimator.Step(test::AllTracked(seen), nullptr);
  for (const double direction_deg : {0.0, 120.0, 220.0, 330.0}) {
    const double rad = direction_deg * M_PI / 180.0;
    seen.position_m[kHandLeft] += 0.05 * Eigen::Vector3d(std::cos(rad), std::sin(rad), 0.0);
    r = estimator.Step(test::AllTracked(seen), nullptr);
  }
  EXPECT_NEAR(r.behaviour[kHandLeft], 5.0 / 9.0, 1e-9);
}

TEST(Reliability, IgnoresVibrationBelowThreeCentimetres) {
  ReliabilityEstimator estimator;
  Reliability r;
  for (int f = 0; f < 10; ++f) {
    Posture seen = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
    seen.position_m[kHandLeft].z() += f % 2 == 0 ? 0.014 : -0.014;
    r = estimator.Step(test::AllTracked(seen), nullptr);
  }
  EXPECT_EQ(r.behaviour[kHandLeft], 1.0);
}

// Eq. 3: both displacements must exceed d_min. Five centimetres out and two back, every second
// frame.
TEST(Reliability, IgnoresTurnsOfWhichOneStepIsBelowThreeCentimetres) {
  ReliabilityEstimator estimator;
  Posture seen = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
  Reliability r;
  for (int f = 0; f < 10; ++f) {
    seen.position_m[kHandLeft].z() += f % 2 == 0 ? 0.05 : -0.02;
    r = estimator.Step(test::AllTracked(seen), nullptr);
    EXPECT_EQ(r.behaviour[kHandLeft], 1.0) << f;
  }
}

// After a frame with the person's bone lengths, one whose left hand is longer by this share.
Reliability OfALongerHand(double share) {
  ReliabilityEstimator estimator;
  const Posture standing = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
  EXPECT_TRUE(IsReferencePosture(standing));
  estimator.Step(test::AllTracked(standing), nullptr);
  Posture wrong = standing;
  const Eigen::Vector3d bone = wrong.position_m[kHandLeft] - wrong.position_m[kHandLeft - 1];
  wrong.position_m[kHandLeft] += share * bone;
  return estimator.Step(test::AllTracked(wrong), nullptr);
}

// Eq. 5 is at most 1: a wrist with one bone three times too long keeps what the other one tells.
TEST(Reliability, CountsAFarTooLongBoneAsOne) {
  const Reliability r = OfALongerHand(2.0);
  EXPECT_NEAR(r.kinematics[kHandLeft], 0.0, 1e-9);
  EXPECT_NEAR(r.kinematics[kHandLeft - 1], 0.5, 1e-9);
}

TEST(Reliability, MeasuresTheBonesOfGuessedJoints) {
  ReliabilityEstimator estimator;
  const Posture standing = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
  estimator.Step(test::AllTracked(standing), nullptr);
  TrackedPosture wrong = test::AllTracked(standing);
  wrong.state[kHandLeft] = TrackingState::kInferred;
  wrong.posture.position_m[kHandLeft] +=
      0.6 * (standing.position_m[kHandLeft] - standing.position_m[kHandLeft - 1]);
  const Reliability r = estimator.Step(wrong, nullptr);
  EXPECT_NEAR(r.kinematics[kHandLeft], 0.4, 1e-9);
  EXPECT_NEAR(r.kinematics[kHandLeft - 1], 0.7, 1e-9);
}

// The position of a joint that is not tracked is meaningless.
TEST(Reliability, IgnoresTheMotionOfUntrackedJoints) {
  ReliabilityEstimator estimator;
  for (int f = 0; f < 10; ++f) {
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1)));
    seen.state[kHandLeft] = f % 3 == 0 ? TrackingState::kTracked : TrackingState::kNotTracked;
    if (f % 3 != 0) seen.posture.position_m[kHandLeft].z() += f % 3 == 1 ? 0.5 : -0.5;
    EXPECT_EQ(estimator.Step(seen, nullptr).behaviour[kHandLeft], 1.0) << f;
  }
}

// A hand four times too far away in the very posture that gives the reference: no person's hand is
// more than twice as long as the standard body's.
TEST(Reliability, BoundsReferenceLengthsByTheSizeOfTheBody) {
  ReliabilityEstimator estimator;
  const Posture standing = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1));
  Posture wrong = standing;
  wrong.position_m[kHandLeft] +=
      3.0 * (standing.position_m[kHandLeft] - standing.position_m[kHandLeft - 1]);
  ASSERT_TRUE(IsReferencePosture(wrong));
  estimator.Step(test::AllTracked(wrong), nullptr);
  const Reliability r = estimator.Step(test::AllTracked(standing), nullptr);
  EXPECT_NEAR(r.kinematics[kHandLeft], 0.5, 1e-9);  // |1 - 2| / 2
}

// Fig. 2: the T-pose and the standing pose, and no other.
TEST(IsReferencePosture, NeedsStraightLegsAndForearms) {
  EXPECT_TRUE(IsReferencePosture(test::Gesture(0.1, 0.1, 0.1)));
  EXPECT_TRUE(IsReferencePosture(test::Gesture(1.57, 1.57, 0.0)));
  EXPECT_FALSE(IsReferencePosture(test::Gesture(0.1, 0.1, 1.5))) << "forearms forward";
  EXPECT_FALSE(IsReferencePosture(test::Gesture(1.57, 0.1, 1.5))) << "one arm";
  Posture kneeling = test::Gesture(0.1, 0.1, 0.1);
  for (const Joint joint : {Joint::kAnkleLeft, Joint::kFootLeft}) {  // a shank 45 degrees back
    kneeling[joint] += Eigen::Vector3d(0.0, 0.12, -0.29);
  }
  EXPECT_FALSE(IsReferencePosture(kneeling));
}

TEST(Reliability, FallsWithAWrongBoneLength) {  // eqs. 5-6: the hand has one bone
  const Reliability r = OfALongerHand(0.6);
  EXPECT_NEAR(r.kinematics[kHandLeft], 0.4, 1e-9);
  EXPECT_NEAR(r.kinematics[kHandLeft - 1], 0.7, 1e-9);  // mean over its two bones
  EXPECT_NEAR(r.kinematics[kHandLeft - 3], 1.0, 1e-9);
}

// A Kinect v2 puts its spine 10 cm higher than the standard body has it, and files of it may have
// no hands: neither makes its joints unreliable.
TEST(Reliability, LearnsTheBonesOfASensorWithAnotherSpineAndNoHands) {
  for (const double arms_rad : {0.1, 0.9}) {  // a reference posture, and none
    ReliabilityEstimator estimator;
    Posture posture = test::Gesture(arms_rad, arms_rad, 0.1);
    posture[Joint::kSpine].y() += 0.1;
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(posture));
    const Eigen::Vector3d up = seen.posture[Joint::kSpine] - seen.posture[Joint::kHipCenter];
    seen.posture[Joint::kSpine] += 0.1 * up.normalized();  // retargeting took the height away
    for (const size_t hand : {size_t{7}, size_t{11}}) {
      seen.state[hand] = TrackingState::kNotTracked;
      seen.posture.position_m[hand].setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    Reliability r;
    for (int f = 0; f < 8; ++f) r = estimator.Step(seen, nullptr);
    for (size_t i = 0; i < kJointCount; ++i) {
      if (i == 7 || i == 11) continue;
      EXPECT_NEAR(r.rate[i], 1.0, 1e-9) << kJointNames[i] << arms_rad;
    }
  }
}

// A Kinect v2's hand lies nearly twice as far from its wrist; nobody need stand straight to learn
// it.
TEST(Reliability, LearnsWhereASensorPutsHands) {
  ReliabilityEstimator estimator;
  Reliability r;
  for (int f = 0; f < 40; ++f) {
    Posture seen = test::InFrontOfCamera(test::Gesture(0.9, 0.9, 0.1, 0.8));
    ASSERT_FALSE(IsReferencePosture(seen));
    for (const size_t hand : {size_t{7}, size_t{11}}) {
      seen.position_m[hand] += 0.8 * (seen.position_m[hand] - seen.position_m[hand - 1]);
    }
    r = estimator.Step(test::AllTracked(seen), nullptr);
  }
  EXPECT_GT(r.kinematics[kHandLeft], 0.95);
  EXPECT_GT(r.kinematics[11], 0.95);
}

TEST(Reliability, InferredAndMissingJointsGiveZero) {  // eq. 7
  ReliabilityEstimator estimator;
  TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1)));
  seen.state[3] = TrackingState::kInferred;
  seen.state[5] = TrackingState::kNotTracked;
  seen.posture.position_m[9].setConstant(std::numeric_limits<double>::quiet_NaN());
  const Reliability r = estimator.Step(seen, nullptr);
  for (const size_t i : {3U, 5U, 9U}) EXPECT_EQ(r.rate[i], 0.0) << i;
  EXPECT_NEAR(r.rate[0], 1.0, 1e-12);
}

TEST(Reliability, RecoversWithinTheGaussianWindow) {  // eq. 8: six frames
  ReliabilityEstimator estimator;
  TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1)));
  seen.state[3] = TrackingState::kInferred;
  estimator.Step(seen, nullptr);
  seen.state[3] = TrackingState::kTracked;
  double last = 0.0;
  for (int f = 0; f < 5; ++f) {
    const double rate = estimator.Step(seen, nullptr).rate[3];
    EXPECT_GT(rate, last);
    EXPECT_LT(rate, 1.0);
    last = rate;
  }
  EXPECT_NEAR(estimator.Step(seen, nullptr).rate[3], 1.0, 1e-12);
}

// Eq. 8 in numbers: w(f) = exp(-f^2 / 8) of the frames back to f = 5 are 1, 0.8825, 0.6065, 0.3247,
// 0.1353 and 0.0439, their sum 2.9930; without those of f = 1 and f = 3, 1.7858.
TEST(Reliability, IsTheWeightedMeanOfSixFrames) {
  ReliabilityEstimator estimator;
  TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1)));
  double rate = 0.0;
  for (const int back : {7, 6, 5, 4, 3, 2, 1, 0}) {
    const bool guessed = back == 7 || back == 3 || back == 1;  // the first is out of the window
    seen.state[3] = guessed ? TrackingState::kInferred : TrackingState::kTracked;
    rate = estimator.Step(seen, nullptr).rate[3];
  }
  EXPECT_NEAR(rate, 0.59667, 1e-5);
}

ReliabilityEstimator WithSpeed() {
  ReliabilityOptions options;
  options.use_speed = true;
  return ReliabilityEstimator(options);
}

TEST(SpeedReliability, FallsForAOneFrameJumpButNotForTheReturn) {
  ReliabilityEstimator estimator = WithSpeed();
  const Posture still = test::InFrontOfCamera(test::Gesture(0.9, 0.1, 0.1));
  const Posture gone = test::InFrontOfCamera(test::Gesture(2.4, 0.1, 0.1));  // the left arm
  for (int f = 0; f < 5; ++f) estimator.Step(test::AllTracked(still), nullptr);
  const Reliability out = estimator.Step(test::AllTracked(gone), nullptr);
  EXPECT_LT(out.speed[5], 0.5);
  EXPECT_LT(out.instant[5], 0.5);
  EXPECT_EQ(out.speed[4], 1.0) << "the shoulder stayed";
  EXPECT_EQ(out.speed[9], 1.0) << "the right elbow stayed";
  const Reliability back = estimator.Step(test::AllTracked(still), nullptr);
  for (const double speed : back.speed) EXPECT_EQ(speed, 1.0);
}

TEST(SpeedReliability, RecoversOnceALimbCouldHaveMovedThere) {
  ReliabilityEstimator estimator = WithSpeed();
  const Posture still = test::InFrontOfCamera(test::Gesture(0.9, 0.1, 0.1));
  const Posture other = test::InFrontOfCamera(test::Gesture(2.4, 0.1, 0.1));
  estimator.Step(test::AllTracked(still), nullptr);
  const double way_m = (other.position_m[5] - still.position_m[5]).norm();
  const int frames = static_cast<int>(std::ceil(30.0 * way_m / 6.5));  // halfway from 5 to 8 m/s
  ASSERT_GT(frames, 1);
  for (int f = 1; f < frames; ++f) {
    EXPECT_LT(estimator.Step(test::AllTracked(other), nullptr).speed[5], 0.5) << f;
  }
  EXPECT_GE(estimator.Step(test::AllTracked(other), nullptr).speed[5], 0.5);
}

TEST(SpeedReliability, IgnoresFastMotionWholeBodyJumpsAndLongSteps) {
  const auto lowest = [](double rad_per_frame, double dt_s, double body_m) {
    ReliabilityEstimator estimator = WithSpeed();
    double least = 1.0;
    for (int f = 0; f < 6; ++f) {
      Posture seen = test::InFrontOfCamera(test::Gesture(rad_per_frame * f, 0.1, 0.1));
      for (auto& p : seen.position_m) p.x() += body_m * f;
      for (const double s : estimator.Step(test::AllTracked(seen), nullptr, dt_s).speed) {
        least = std::min(least, s);
      }
    }
    return least;
  };
  // An arm of a quarter of a metre to the elbow, a revolution in less than half a second.
  EXPECT_EQ(lowest(0.45, 1.0 / 30.0, 0.0), 1.0);
  EXPECT_EQ(lowest(0.0, 1.0 / 30.0, 0.5), 1.0);
  EXPECT_LT(lowest(1.2, 1.0 / 30.0, 0.0), 0.5);
  EXPECT_EQ(lowest(1.2, 0.1, 0.0), 1.0);
}

TEST(SpeedReliability, IsOffForThePapersMethods) {
  ReliabilityEstimator estimator;
  estimator.Step(test::AllTracked(test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.1))), nullptr);
  const Posture far = test::InFrontOfCamera(test::Gesture(2.4, 0.1, 0.1));
  for (const double s : estimator.Step(test::AllTracked(far), nullptr).speed) EXPECT_EQ(s, 1.0);
}

TEST(SurfaceReliability, DistinguishesHiddenFloatingAndVisibleJoints) {
  depth::DepthFrame frame;
  frame.camera = depth::KinectV1Camera(160, 120);
  frame.depth_mm.assign(160 * 120, 2400);
  Posture posture;
  for (auto& p : posture.position_m) p = {0.0, 0.0, 2.45};  // 5 cm behind the surface
  posture.position_m[1] = {0.1, 0.1, 3.0};                  // 60 cm behind: hidden
  posture.position_m[2] = {0.1, 0.1, 2.0};                  // 40 cm before: in the air
  posture.position_m[3] = {9.0, 0.1, 2.0};                  // outside the image
  const JointWeights s = SurfaceReliability(posture, frame);
  EXPECT_EQ(s[0], 1.0);
  EXPECT_EQ(s[1], 0.0);
  EXPECT_EQ(s[2], 0.0);
  EXPECT_EQ(s[3], 1.0);
}

}  // namespace
}  // namespace ossa::recon
