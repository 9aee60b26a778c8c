// The method `best`: its stages, and robustness to bad inputs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/bone_projection.h"
#include "recon/filters/lag_filter_internal.h"
#include "recon/methods/reconstructor.h"
#include "recon/models/posture_prior.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/places.h"

namespace ossa::recon {
namespace {

constexpr double kStep_s = 1.0 / 30.0;

std::unique_ptr<Reconstructor> MakeBestOne(bool refined_joints = false) {
  // As it is shipped.
  static const auto prior = std::make_shared<PosturePrior>(
      PosturePrior::Load(ossa::test::SourceFolder() / "tools/tracker/shipped" / kShippedPrior));
  ReconstructorOptions options;
  options.prior = prior;
  options.best.refined_joints = refined_joints;
  return MakeReconstructor(options);
}

/// Completes hidden joints from a database that contains the motion, which the prior does not.
std::unique_ptr<Reconstructor> MakeBestByDatabase() {
  ReconstructorOptions options;
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  return MakeReconstructor(options);
}

ReconstructedPosture StepOn(Reconstructor& method, const TrackedPosture& observed, double time_s) {
  const auto made = method.Step({observed, time_s, nullptr});
  for (const auto& p : made.posture.position_m) EXPECT_TRUE(p.allFinite());
  return made;
}

Posture At(double time_s, double scale = 1.0) {
  return test::InFrontOfCamera(test::Motion(time_s), scale);
}

/// Processes a second and a half of a well-observed person; returns the time of the next frame.
double SeenWell(Reconstructor& method, double scale = 1.0) {
  for (int f = 0; f < 45; ++f) {
    StepOn(method, test::AllTracked(At(f * kStep_s, scale)), f * kStep_s);
  }
  return 45 * kStep_s;
}

double LargestReliability(const ReconstructedPosture& made) {
  return *std::max_element(made.reliability.begin(), made.reliability.end());
}

TEST(Best, KeepsThePostureWhileAllJointsAreMissing) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  const Posture last = At(t - kStep_s);
  for (int f = 0; f < 6; ++f) {
    const auto made = StepOn(*method, TrackedPosture(), t + f * kStep_s);
    EXPECT_EQ(LargestReliability(made), 0.0);
    // Without observations the person stops within a hand's width.
    EXPECT_LT(test::MeanDistance_m(made.posture, last), 0.1) << f;
  }
}

TEST(Best, TreatsNanAsMissing) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture observed = test::AllTracked(At(t));
  for (const size_t i : {size_t{6}, size_t{7}, size_t{18}}) {
    observed.posture.position_m[i].setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  const auto made = StepOn(*method, observed, t);
  EXPECT_EQ(made.reliability[7], 0.0);
  EXPECT_LT(test::MeanDistance_m(made.posture, At(t)), 0.05);
}

// One guess with a NaN confidence must not corrupt a filter permanently.
TEST(Best, TreatsANanConfidenceAsZero) {
  const auto method = MakeBestOne();
  double t = SeenWell(*method);
  TrackedPosture guess = test::AllTracked(At(t));
  guess.state[5] = TrackingState::kInferred;
  guess.confidence[5] = std::numeric_limits<double>::quiet_NaN();
  StepOn(*method, guess, t);
  ReconstructedPosture made;
  for (int f = 0; f < 30; ++f) {
    t += kStep_s;
    made = StepOn(*method, test::AllTracked(At(t)), t);
  }
  EXPECT_LT(test::MeanDistance_m(made.posture, At(t)), 0.01);
}

TEST(Best, TrustsUnrefinedGuessesLittle) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture observed = test::AllTracked(At(t));
  const auto hand = Index(Joint::kHandLeft);
  observed.state[hand] = TrackingState::kInferred;
  observed.posture.position_m[hand].x() += 0.1;
  const auto made = StepOn(*method, observed, t);
  // A tenth of trust of the half that is needed moves it by a fifth, the filter by less.
  EXPECT_LT((made.posture.position_m[hand] - At(t).position_m[hand]).norm(), 0.03);
}

// Joints behind a wall are invisible, but cascaded refinement was trained to place them.
TEST(Best, TrustsARefinedJointBehindAnOccluder) {
  depth::DepthFrame wall;
  wall.camera = depth::KinectV1Camera(320, 240);
  wall.depth_mm.assign(320 * 240, 1000);
  const auto hand = Index(Joint::kHandLeft);
  const auto off_m = [&](bool looked) {
    const auto method = MakeBestOne(looked);
    const double t = SeenWell(*method);
    TrackedPosture observed = test::AllTracked(At(t));
    const Eigen::Vector3d forearm_m =
        observed.posture.position_m[hand] - observed.posture[Joint::kElbowLeft];
    const Eigen::AngleAxisd turn(0.5, Eigen::Vector3d::UnitX());
    observed.posture.position_m[hand] = observed.posture[Joint::kElbowLeft] + turn * forearm_m;
    observed.posture[Joint::kWristLeft] =
        observed.posture[Joint::kElbowLeft] +
        turn * (observed.posture[Joint::kWristLeft] - observed.posture[Joint::kElbowLeft]);
    ReconstructedPosture made;
    for (int f = 0; f < 6; ++f) made = method->Step({observed, t + f * kStep_s, &wall});
    return (made.posture.position_m[hand] - observed.posture.position_m[hand]).norm();
  };
  EXPECT_LT(off_m(true), 0.03);
  EXPECT_GT(off_m(false), 0.06);
}

TEST(Best, MovesARefinedTrunkLittle) {
  const auto moved_m = [](bool looked) {
    const auto method = MakeBestOne(looked);
    const double t = SeenWell(*method);
    TrackedPosture observed = test::AllTracked(At(t));
    observed.posture[Joint::kShoulderLeft] +=
        0.06 * (observed.posture[Joint::kShoulderLeft] - observed.posture[Joint::kShoulderCenter])
                   .normalized();
    const auto made = StepOn(*method, observed, t);
    return (made.posture[Joint::kShoulderCenter] - observed.posture[Joint::kShoulderCenter]).norm();
  };
  EXPECT_LT(moved_m(true), 0.8 * moved_m(false));
}

TEST(Best, StaysFiniteWithBonesOfLengthZero) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture observed = test::AllTracked(At(t));
  for (auto& p : observed.posture.position_m) p = observed.posture.position_m[0];
  const BoneLengths lengths = MeasureBoneLengths(StepOn(*method, observed, t).posture);
  for (size_t i = 1; i < kJointCount; ++i) EXPECT_GT(lengths[i], 0.02) << i;
}

TEST(Best, FollowsChildrenAndTallPeople) {
  for (const double stature_m : {0.9, 2.2}) {
    const double scale = stature_m / 1.66;
    const auto method = MakeBestOne();
    const double t = SeenWell(*method, scale);
    const auto made = StepOn(*method, test::AllTracked(At(t, scale)), t);
    EXPECT_LT(test::MeanDistance_m(made.posture, At(t, scale)), 0.03) << stature_m;
  }
}

TEST(Best, FollowsAtAVaryingFrameRate) {
  const auto method = MakeBestOne();
  double t = SeenWell(*method);
  for (const double step_s : {0.1, 0.005, 0.2, 1.0 / 60, 1.0 / 15, 1.0 / 120, 0.1}) {
    t += step_s;
    const auto made = StepOn(*method, test::AllTracked(At(t)), t);
    // Joints move by up to 1 m/s here: half of what the longest step leaves unseen.
    EXPECT_LT(test::MeanDistance_m(made.posture, At(t)), 0.1) << step_s;
  }
}

TEST(Best, RestartsAfterAGapOfSeconds) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method) + 7.0;
  const auto made = StepOn(*method, test::AllTracked(At(t)), t);
  EXPECT_LT(test::MeanDistance_m(made.posture, At(t)), 0.02);
  EXPECT_FALSE(method->Revised().has_value());  // nothing is known between
}

TEST(Best, CorrectsExchangedSides) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture observed = test::AllTracked(At(t));
  for (size_t i = 0; i < kJointCount; ++i) {
    observed.posture.position_m[i] = At(t).position_m[kMirroredJoint[i]];
  }
  const auto made = StepOn(*method, observed, t);
  EXPECT_LT(test::MeanDistance_m(made.posture, At(t)), 0.05);
  EXPECT_LE(LargestReliability(made), 0.5);
}

TEST(Best, AcceptsSidesThatStayExchanged) {
  const auto method = MakeBestOne();
  double t = SeenWell(*method);
  Posture turned;
  ReconstructedPosture made;
  for (int f = 0; f < 30; ++f, t += kStep_s) {
    for (size_t i = 0; i < kJointCount; ++i) {
      turned.position_m[i] = At(t).position_m[kMirroredJoint[i]];
    }
    made = StepOn(*method, test::AllTracked(turned), t);
  }
  EXPECT_LT(test::MeanDistance_m(made.posture, turned), 0.05);
}

TEST(Best, EstimatesAHiddenLegFromTheOtherAndKeepsVisibleJoints) {
  const auto method = MakeBestByDatabase();
  double t = SeenWell(*method);
  double hidden_m = 0.0, seen_m = 0.0;
  for (int f = 0; f < 60; ++f, t += kStep_s) {
    TrackedPosture observed = test::AllTracked(At(t));
    for (size_t i = 17; i < kJointCount; ++i) observed.state[i] = TrackingState::kNotTracked;
    const auto made = StepOn(*method, observed, t);
    hidden_m += (made.posture.position_m[17] - At(t).position_m[17]).norm() / 60.0;
    seen_m += (made.posture.position_m[6] - At(t).position_m[6]).norm() / 60.0;
  }
  // The knees swing together, the hidden one by 15 cm in these two seconds; the database knows them
  // every 23 degrees, 16 cm of a thigh.
  EXPECT_LT(hidden_m, 0.08);
  EXPECT_LT(seen_m, 0.02);
}

/// Mean error over two seconds of joints attached to hidden ones.
double HiddenError_m(const std::vector<Joint>& hidden, Joint measured) {
  const auto method = MakeBestOne();
  double t = SeenWell(*method), sum_m = 0.0;
  constexpr int kFrames = 60;
  for (int f = 0; f < kFrames; ++f, t += kStep_s) {
    TrackedPosture observed = test::AllTracked(At(t));
    for (const Joint joint : hidden) {
      observed.state[joint] = TrackingState::kNotTracked;
    }
    const auto made = StepOn(*method, observed, t);
    sum_m += (made.posture[measured] - At(t)[measured]).norm();
  }
  return sum_m / kFrames;
}

TEST(Best, AHiddenArmReachesTheVisibleHand) {
  // What lies between shoulder and hand: the hand tells more of the elbow than the rest of the
  // body.
  const std::vector<Joint> arm = {Joint::kElbowLeft, Joint::kWristLeft};
  std::vector<Joint> and_hand = arm;
  and_hand.push_back(Joint::kHandLeft);
  EXPECT_LT(HiddenError_m(arm, Joint::kElbowLeft),
            0.8 * HiddenError_m(and_hand, Joint::kElbowLeft));
}

TEST(Best, AHiddenAnkleDoesNotLieOnTheLineFromKneeToFoot) {
  // On that line it would be off by most of a foot's length, 10 cm and more.
  EXPECT_LT(HiddenError_m({Joint::kAnkleLeft}, Joint::kAnkleLeft), 0.05);
}

TEST(Best, IgnoresAJumpToAnotherBodyAndBack) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture other = test::AllTracked(At(t, 0.6));
  for (auto& p : other.posture.position_m) p.x() += 1.0;
  for (int f = 0; f < 2; ++f) {
    const double now_s = t + f * kStep_s;
    EXPECT_LT(test::MeanDistance_m(StepOn(*method, other, now_s).posture, At(now_s)), 0.15);
  }
  const double back_s = t + 2 * kStep_s;
  const auto made = StepOn(*method, test::AllTracked(At(back_s)), back_s);
  EXPECT_LT(test::MeanDistance_m(made.posture, At(back_s)), 0.1);
}

TEST(Best, HoldsAHandThatSnapsToTheOther) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture observed = test::AllTracked(At(t));
  for (const size_t i : {size_t{6}, size_t{7}}) {
    observed.posture.position_m[i] = At(t).position_m[kMirroredJoint[i]];
  }
  const auto made = StepOn(*method, observed, t);
  const double off_m = (made.posture.position_m[7] - At(t).position_m[7]).norm();
  EXPECT_LT(off_m, 0.3 * (observed.posture.position_m[7] - At(t).position_m[7]).norm());
}

// The forearm keeps its length and is far from the other hand: only its speed is implausible.
TEST(Best, HoldsAForearmThatIsElsewhereForOneFrame) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  TrackedPosture observed = test::AllTracked(At(t));
  const Eigen::Vector3d elbow = observed.posture.position_m[5];
  for (const size_t i : {size_t{6}, size_t{7}}) {
    observed.posture.position_m[i] = 2.0 * elbow - observed.posture.position_m[i];
  }
  const auto made = StepOn(*method, observed, t);
  EXPECT_LT(made.reliability[6], 0.5);
  EXPECT_GT(made.reliability[5], 0.5);
  const double off_m = (made.posture.position_m[7] - At(t).position_m[7]).norm();
  EXPECT_LT(off_m, 0.3 * (observed.posture.position_m[7] - At(t).position_m[7]).norm());
}

TEST(Best, ATooLongForearmDoesNotMoveTheElbow) {
  const auto method = MakeBestOne();
  const double t = SeenWell(*method);
  const auto elbow = Index(Joint::kElbowLeft);
  const auto wrist = Index(Joint::kWristLeft);
  const auto hand = Index(Joint::kHandLeft);
  Posture seen = At(t);
  const Eigen::Vector3d forearm = seen.position_m[wrist] - seen.position_m[elbow];
  constexpr double kTooLong_m = 0.05;
  for (const size_t i : {wrist, hand}) seen.position_m[i] += kTooLong_m * forearm.normalized();
  const auto made = StepOn(*method, test::AllTracked(seen), t);
  // With equal weights the elbow takes 0.4 of it; the far end takes most here, 0.25 are left.
  const double elbow_m = (made.posture.position_m[elbow] - At(t).position_m[elbow]).norm();
  EXPECT_LT(elbow_m, 0.3 * kTooLong_m);
}

TEST(Best, RevisesAFrameOnceTheNextIsKnown) {
  const auto method = MakeBestOne();
  std::mt19937_64 rng(3);
  double now_m = 0.0, revised_m = 0.0;
  for (int f = 0; f < 120; ++f) {
    Posture seen = At(f * kStep_s);
    test::AddNoise(seen, 0.005, rng);
    const auto made = StepOn(*method, test::AllTracked(seen), f * kStep_s);
    if (f >= 30) now_m += test::MeanDistance_m(made.posture, At(f * kStep_s));
    if (f >= 31) {
      ASSERT_TRUE(method->Revised().has_value());
      revised_m += test::MeanDistance_m(method->Revised()->posture, At((f - 1) * kStep_s));
    }
  }
  EXPECT_LT(revised_m, 0.9 * now_m);
}

TEST(WithBoneLengths, GivesExactLengthsAndMovesLessThanRetargeting) {
  const BoneLengths wanted = StandardBoneLengths();
  JointWeights weights;
  weights.fill(1.0);
  std::mt19937_64 rng(9);
  for (int trial = 0; trial < 20; ++trial) {
    Posture noisy = test::Motion(0.3 * trial);
    test::AddNoise(noisy, 0.03, rng);
    const Posture moved = WithBoneLengths(noisy, wanted, weights);
    const BoneLengths lengths = MeasureBoneLengths(moved);
    for (size_t i = 1; i < kJointCount; ++i) EXPECT_NEAR(lengths[i], wanted[i], 1e-8);
    EXPECT_LT(test::MeanDistance_m(moved, noisy),
              0.8 * test::MeanDistance_m(Retargeted(noisy, wanted), noisy));
  }
}

TEST(WithBoneLengths, MovesHeavyJointsLeast) {
  Posture posture = test::Motion(0.0);
  BoneLengths wanted = StandardBoneLengths();
  wanted[5] *= 1.1;
  JointWeights weights;
  weights.fill(1.0);
  weights[5] = 1e6;
  const Posture moved = WithBoneLengths(posture, wanted, weights);
  // A millionth of the 3 cm that are to be made up for.
  EXPECT_LT((moved.position_m[5] - posture.position_m[5]).norm(), 1e-6);
}

/// Mean error of a swinging joint with noise: of the input, and of the revised output.
std::pair<double, double> ErrorsOf(double noise_m) {
  std::mt19937_64 rng(17);
  std::normal_distribution<double> normal(0.0, noise_m);
  LagFilter filter;
  const auto truth = [](int f) {
    return Eigen::Vector3d(0.3 * std::sin(3.0 * f * kStep_s), 0.2 * std::cos(2.0 * f * kStep_s), 2);
  };
  double before = 0.0, after = 0.0;
  for (int f = 0; f < 600; ++f) {
    const Eigen::Vector3d seen = truth(f) + Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
    filter.Step(seen, kStep_s, 1.0);
    if (f < 60) continue;
    before += (seen - truth(f)).norm();
    after += (filter.before_m() - truth(f - 1)).norm();
  }
  return {before, after};
}

TEST(LagFilter, RemovesNoiseOfSteadyAndOfJumpySensors) {
  for (const double noise_m : {0.003, 0.05}) {
    const auto [before, after] = ErrorsOf(noise_m);
    EXPECT_LT(after, 0.8 * before) << noise_m;
  }
}

TEST(LagFilter, KeepsSmoothMotion) {
  // 90 cm/s at most: less than a millimetre of a frame's 3 cm is lost.
  EXPECT_LT(ErrorsOf(0.0).second / 540, 0.001);
}

}  // namespace
}  // namespace ossa::recon
