#include "tools/experiments/compare/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "recon/files/skeleton_io.h"

namespace ossa::tools {
namespace {

using recon::BodyRecord;
using recon::Joint;
using recon::SkeletonSequence;

constexpr double kExact = 1e-9;  // rounding of a few double operations on metres

// A person whose joints all swing differently, so that clocks can be told from the motion.
SkeletonSequence Swinging(int frames, double step_s, double start_s = 0.0) {
  SkeletonSequence sequence{"swinging", {}};
  for (int f = 0; f < frames; ++f) {
    recon::SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = start_s + f * step_s;
    BodyRecord body;
    body.id = 1;
    const double t = f * step_s;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const auto joint = static_cast<double>(j);
      recon::JointRecord record;
      record.position_m = {0.1 * joint, 0.3 * std::sin((2 + 0.1 * joint) * t + joint),
                           2 + 0.2 * std::sin(0.7 * t * t)};
      body.joints[j] = record;
    }
    frame.bodies.push_back(body);
    sequence.frames.push_back(frame);
  }
  return sequence;
}

template <typename Change>
SkeletonSequence Changed(SkeletonSequence sequence, Change change) {
  for (size_t f = 0; f < sequence.frames.size(); ++f) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      change(f, static_cast<Joint>(j), sequence.frames[f].bodies[0].joints[j]);
    }
  }
  return sequence;
}

ClipMetrics MeasureOne(const SkeletonSequence& truth, const SkeletonSequence& result,
                       const PairOptions& options = {}) {
  const auto pairs = PairUp(truth, result, options);
  EXPECT_EQ(pairs.size(), 1u);
  return Measure(pairs.at(0));
}

TEST(Metrics, AreZeroForAPerfectResult) {
  const auto truth = Swinging(30, 1 / 30.0);
  const ClipMetrics m = MeasureOne(truth, truth);
  EXPECT_EQ(m.frames, 30);
  EXPECT_EQ(*m.mean_joint_error_cm, 0);
  EXPECT_EQ(*m.parent_relative_error_cm, 0);
  EXPECT_EQ(*m.fraction_frames_over_20cm, 0);
  EXPECT_EQ(*m.fraction_joints_within_10cm, 1);
  EXPECT_EQ(*m.map_10cm, 1);
  EXPECT_EQ(*m.acceleration_error_cm_per_frame2, 0);
}

TEST(Metrics, OfAShiftedResultAreTheShiftAndZeroRelativeToParents) {
  const auto truth = Swinging(30, 1 / 30.0);
  const auto result = Changed(truth, [](size_t, Joint, auto& joint) {
    joint->position_m += Eigen::Vector3d(0.03, 0, 0.04);
  });
  const ClipMetrics m = MeasureOne(truth, result);
  EXPECT_NEAR(*m.mean_joint_error_cm, 5.0, kExact);
  EXPECT_NEAR(*m.parent_relative_error_cm, 0.0, kExact);
  EXPECT_NEAR(*m.offset_removed_error_cm, 0.0, kExact);
  EXPECT_NEAR(*m.acceleration_error_cm_per_frame2, 0.0, kExact);
  EXPECT_NEAR(*m.per_joint_cm[7], 5.0, kExact);
}

// One hand 30 cm off: eq. 18 sees it in one bone of 19, the mean in one joint of 20.
TEST(Metrics, OfOneWrongHandEqualTheClosedForm) {
  const auto truth = Swinging(10, 1 / 30.0);
  const auto result = Changed(truth, [](size_t, Joint j, auto& joint) {
    if (j == Joint::kHandLeft) joint->position_m.x() += 0.3;
  });
  const ClipMetrics m = MeasureOne(truth, result);
  EXPECT_NEAR(*m.mean_joint_error_cm, 30.0 / 20, kExact);
  EXPECT_NEAR(*m.parent_relative_error_cm, 30.0 / 19, kExact);
  EXPECT_NEAR(*m.fraction_joints_within_10cm, 19.0 / 20, kExact);
  EXPECT_NEAR(*m.map_10cm, 19.0 / 20, kExact);
  EXPECT_EQ(*m.fraction_frames_over_20cm, 0);
}

// A wrist that jumps 20 cm up and down every frame: its second difference is 80 cm, over 20 joints.
TEST(Metrics, OfAJitteringWristEqualTheClosedForm) {
  const auto truth = Swinging(20, 1 / 30.0);
  const auto result = Changed(truth, [](size_t f, Joint j, auto& joint) {
    if (j == Joint::kWristRight) joint->position_m.y() += f % 2 == 0 ? 0.2 : 0.0;
  });
  const ClipMetrics m = MeasureOne(truth, result);
  EXPECT_NEAR(*m.acceleration_error_cm_per_frame2, 40.0 / 20, kExact);
  // Its offset is 10 cm, what is left 10 cm every frame.
  EXPECT_NEAR(*m.offset_removed_error_cm, 10.0 / 20, kExact);
  // Relative to its parent it is off, and its child the hand relative to it: two bones, 10 frames.
  EXPECT_NEAR(*m.parent_relative_error_cm, 2 * 20.0 / 19 / 2, kExact);
}

TEST(Metrics, CountFramesWhoseParentRelativeErrorIsOverTwentyCentimetres) {
  const auto truth = Swinging(10, 1 / 30.0);
  // Every joint 21 cm further from its parent than it is: eq. 13 is 21 cm in three frames of ten.
  const auto result = Changed(truth, [](size_t f, Joint j, auto& joint) {
    if (f >= 3) return;
    for (size_t i = recon::Index(j); i > 0; i = recon::ParentOf(i)) {
      joint->position_m.x() += 0.21;
    }
  });
  EXPECT_NEAR(*MeasureOne(truth, result).fraction_frames_over_20cm, 0.3, kExact);
}

TEST(Metrics, MissingJointCountsAsNotFoundAndInNoMean) {
  const auto truth = Swinging(10, 1 / 30.0);
  const auto result = Changed(truth, [](size_t f, Joint j, auto& joint) {
    if (j == Joint::kHead && f < 5) joint.reset();
    if (j == Joint::kSpine) joint->state = recon::TrackingState::kNotTracked;
  });
  const ClipMetrics m = MeasureOne(truth, result);
  EXPECT_EQ(*m.mean_joint_error_cm, 0);
  EXPECT_NEAR(*m.fraction_joints_missing, 15.0 / 200, kExact);
  EXPECT_NEAR(*m.fraction_joints_within_10cm, 185.0 / 200, kExact);
  EXPECT_NEAR(*m.ap_10cm[Joint::kHead], 0.5, kExact);
  // Without the spine the shoulders' centre is compared relative to the hips' centre.
  EXPECT_EQ(*m.parent_relative_error_cm, 0);
}

// State not_tracked: the sensor did not see it; a reliability: a method has placed it.
TEST(Metrics, PlacedJointThatIsNotTrackedIsScored) {
  const auto truth = Swinging(30, 1 / 30.0);
  const auto result = Changed(truth, [](size_t, Joint j, auto& joint) {
    if (j != Joint::kHandLeft) return;
    joint->state = recon::TrackingState::kNotTracked;
    joint->reliability = 0.0;
    joint->position_m.y() += 0.5;
  });
  const ClipMetrics m = MeasureOne(truth, result);
  EXPECT_EQ(*m.fraction_joints_missing, 0);
  EXPECT_NEAR(*m.mean_joint_error_cm, 50.0 / 20, kExact);
  const ClipMetrics found = MeasureOne(truth, result, {.found_only = true});
  EXPECT_NEAR(*found.fraction_joints_missing, 1.0 / 20, kExact);
  EXPECT_EQ(*found.mean_joint_error_cm, 0);
}

TEST(AveragePrecision, RanksByConfidence) {
  const auto truth = Swinging(4, 1 / 30.0);
  // Confidences .9 .8 .7 .6, the second wrong: precisions at the hits are 1, 2/3, 3/4, each a
  // quarter of the recall.
  const auto result = Changed(truth, [](size_t f, Joint, auto& joint) {
    joint->confidence = 0.9 - 0.1 * static_cast<double>(f);
    if (f == 1) joint->position_m.x() += 0.5;
  });
  EXPECT_NEAR(*MeasureOne(truth, result).map_10cm, (1 + 2 / 3.0 + 3 / 4.0) / 4, kExact);
}

TEST(BoneVariation, IsTheStandardDeviationOverTheMean) {
  const auto truth = Swinging(10, 1 / 30.0);
  auto result = Changed(truth, [](size_t f, Joint j, auto& joint) {
    joint->position_m = {0, 0, 2};
    if (j == Joint::kHandLeft) joint->position_m.x() = f % 2 == 0 ? 0.9 : 1.1;
  });
  // Lengths 0.9 and 1.1: mean 1, deviation 0.1. All other bones have no length and do not count.
  EXPECT_NEAR(*MeasureOne(truth, result).bone_length_variation_percent, 10, 1e-6);
}

TEST(RigidAlignment, RecoversARotationAndATranslation) {
  const auto truth = Swinging(30, 1 / 30.0);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto result = Changed(truth, [&](size_t, Joint, auto& joint) {
    joint->position_m = turn * joint->position_m + Eigen::Vector3d(1, -2, 0.5);
  });
  PairOptions rigid;
  rigid.rigid = true;
  EXPECT_GT(*MeasureOne(truth, result).mean_joint_error_cm, 50);
  EXPECT_NEAR(*MeasureOne(truth, result, rigid).mean_joint_error_cm, 0, 1e-6);
}

TEST(RigidAlignment, NeverMirrorsOrScales) {
  const auto truth = Swinging(30, 1 / 30.0);
  const auto mirrored = Changed(
      truth, [](size_t, Joint, auto& joint) { joint->position_m.x() = -joint->position_m.x(); });
  const auto doubled = Changed(truth, [](size_t, Joint, auto& joint) { joint->position_m *= 2.0; });
  PairOptions rigid;
  rigid.rigid = true;
  // A mirroring or scaling fit would leave nothing.
  EXPECT_GT(*MeasureOne(truth, mirrored, rigid).mean_joint_error_cm, 3);
  EXPECT_GT(*MeasureOne(truth, doubled, rigid).mean_joint_error_cm, 10);
}

TEST(TimeAlignment, FindsTheOffsetOfAnotherClockAndRate) {
  const auto truth = Swinging(600, 0.01);
  auto result = Swinging(120, 0.05);
  // The result's clock says 100 s more, and it began 0.42 s into the truth.
  result.frames.erase(result.frames.begin(), result.frames.begin() + 9);
  for (auto& frame : result.frames) frame.time_s += 100.0 - 0.03;
  const auto pairs = PairUp(truth, result);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_FALSE(pairs[0].same_clock);
  // The correlation is taken on a 10 ms grid and refined between.
  EXPECT_NEAR(pairs[0].offset_s, -100.0 + 0.03, 0.01);
  // Linear interpolation and 10 ms at under 1 m/s.
  EXPECT_LT(*Measure(pairs[0]).mean_joint_error_cm, 1.0);
}

// The result's frames fall between the truth's, and it begins when the truth has run for long.
TEST(TimeAlignment, FindsThatClocksAgreeWhenTheResultBeginsLate) {
  const auto truth = Swinging(300, 1 / 30.0);
  auto result = Swinging(600, 1 / 60.0);
  std::erase_if(result.frames, [](const auto& frame) {
    return frame.frame % 2 == 0 || frame.frame < 360;  // 6 s, three times what is looked through
  });
  const auto pairs = PairUp(truth, result);
  EXPECT_FALSE(pairs.at(0).same_clock);
  // The correlation is taken on a 10 ms grid and refined between.
  EXPECT_NEAR(pairs.at(0).offset_s, 0.0, 0.01);
}

// A squat: down in 1.5 s, and up at the same speeds. The way up is noisier, so that the way down
// correlates better with another recording's way up than the two whole recordings do.
SkeletonSequence Squat(double step_s, double noise_m) {
  SkeletonSequence squat = Swinging(static_cast<int>(3.0 / step_s), step_s);
  for (auto& frame : squat.frames) {
    const double way = std::fmod(frame.time_s, 1.5) / 1.5, t = frame.time_s;
    const double share = way * way * (3 - 2 * way);
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const double depth_m = 0.02 * static_cast<double>(j) * (t < 1.5 ? share : 1 - share);
      const double off_m =
          (t < 1.5 ? 0.5 : 1.0) * noise_m * std::sin(20 * t + static_cast<double>(j));
      frame.bodies[0].joints[j]->position_m = {0.1, 1 - depth_m + off_m, 2};
    }
  }
  return squat;
}

TEST(TimeAlignment, DoesNotConfuseTheHalvesOfASymmetricMovement) {
  const auto pairs = PairUp(Squat(0.01, 0.0), Squat(1 / 30.0, 0.003));
  EXPECT_FALSE(pairs.at(0).same_clock);
  EXPECT_NEAR(pairs.at(0).offset_s, 0.0, 0.05);
}

// Hands go to one side and back, half a cycle a second; one of the swings is wider.
SkeletonSequence Waving(double step_s, int wide_swing, double noise_m) {
  SkeletonSequence waving = Swinging(static_cast<int>(6.0 / step_s), step_s);
  for (auto& frame : waving.frames) {
    const double wide = std::floor(frame.time_s) == wide_swing ? 2 : 1;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const double place = static_cast<double>(j);
      frame.bodies[0].joints[j]->position_m = {0.1 * std::sin(place), 0.08 * place, 2};
    }
    for (const Joint hand : {Joint::kHandLeft, Joint::kHandRight}) {
      frame.bodies[0].joints[recon::Index(hand)]->position_m.x() +=
          0.1 * wide * std::sin(std::numbers::pi * frame.time_s) +
          noise_m * std::sin(23 * frame.time_s);
    }
  }
  return waving;
}

// The speeds alone correlate best where the wide swings meet, which go to opposite sides.
TEST(TimeAlignment, AlignsARepeatedMovementByJointPositions) {
  const auto pairs = PairUp(Waving(0.01, 2, 0.0), Waving(1 / 30.0, 3, 0.004));
  EXPECT_FALSE(pairs.at(0).same_clock);
  EXPECT_NEAR(pairs.at(0).offset_s, 0.0, 0.05);
}

TEST(TimeAlignment, KeepsALagWhenFrameTimesAgree) {
  const auto truth = Swinging(90, 1 / 30.0);
  auto late = truth;
  for (size_t f = late.frames.size() - 1; f > 0; --f) {
    late.frames[f].bodies = late.frames[f - 1].bodies;
  }
  EXPECT_EQ(MeasureOne(truth, late).offset_s, 0);
  EXPECT_GT(*MeasureOne(truth, late).mean_joint_error_cm, 0.5);
  PairOptions correlate;
  correlate.time = TimeAlignment::kCorrelate;
  EXPECT_NEAR(MeasureOne(truth, late, correlate).offset_s, -1 / 30.0, 0.01);
}

TEST(TimeAlignment, DoesNotInterpolateAcrossAGap) {
  auto truth = Swinging(60, 1 / 30.0);
  truth.frames.erase(truth.frames.begin() + 20, truth.frames.begin() + 40);
  const auto result = Swinging(60, 1 / 30.0);
  PairOptions options;
  options.time = TimeAlignment::kNone;
  EXPECT_EQ(MeasureOne(truth, result, options).frames, 40);
}

TEST(SeveralPeople, AreMatchedByPositionNotById) {
  auto truth = Swinging(10, 1 / 30.0);
  auto result = truth;
  for (size_t f = 0; f < truth.frames.size(); ++f) {
    auto other = truth.frames[f].bodies[0];
    other.id = 2;
    for (auto& joint : other.joints) joint->position_m.x() += 3.0;
    truth.frames[f].bodies.push_back(other);
    auto first = truth.frames[f].bodies[0];
    first.id = 9;
    other.id = 8;
    result.frames[f].bodies = {other, first};
  }
  const auto pairs = PairUp(truth, result);
  ASSERT_EQ(pairs.size(), 2u);
  for (const auto& pair : pairs) EXPECT_EQ(*Measure(pair).mean_joint_error_cm, 0);
}

// One person, and a false body in every third frame.
SkeletonSequence WithGhosts(SkeletonSequence sequence) {
  for (size_t f = 0; f < sequence.frames.size(); f += 3) {
    BodyRecord ghost = sequence.frames[f].bodies[0];
    ghost.id = 7;
    for (auto& joint : ghost.joints) joint->position_m.x() += 1.5;
    auto& bodies = sequence.frames[f].bodies;
    bodies.insert(bodies.begin(), ghost);
  }
  return sequence;
}

TEST(OnePerson, IsPairedEquallyWithAndWithoutAFalseBody) {
  const auto truth = Swinging(30, 1 / 30.0);
  const auto pairs = PairUp(truth, WithGhosts(truth));
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].name, PairUp(truth, truth)[0].name);
  EXPECT_EQ(Measure(pairs[0]).frames, 30);
  EXPECT_EQ(*Measure(pairs[0]).mean_joint_error_cm, 0);
}

TEST(OnePerson, IsPairedOnAnotherClockWithAndWithoutAFalseBody) {
  const auto truth = Swinging(150, 1 / 30.0);
  auto result = truth;
  for (auto& frame : result.frames) frame.time_s += 100.013;
  const auto alone = PairUp(truth, result)[0];
  const auto haunted = PairUp(truth, WithGhosts(result))[0];
  EXPECT_FALSE(haunted.same_clock);
  EXPECT_EQ(haunted.offset_s, alone.offset_s);
  EXPECT_EQ(*Measure(haunted).mean_joint_error_cm, *Measure(alone).mean_joint_error_cm);
}

// Two people, whose clock is half a second late.
TEST(SeveralPeople, AreComparedAtTheRequestedTimes) {
  auto truth = Swinging(90, 1 / 30.0);
  for (auto& frame : truth.frames) {
    auto other = frame.bodies[0];
    other.id = 2;
    for (auto& joint : other.joints) joint->position_m.x() += 3.0;
    frame.bodies.push_back(other);
  }
  auto late = truth;
  for (auto& frame : late.frames) frame.time_s += 0.5;
  const auto error_cm = [&](const PairOptions& options) {
    double worst = 0;
    for (const auto& pair : PairUp(truth, late, options)) {
      worst = std::max(worst, *Measure(pair).mean_joint_error_cm);
    }
    return worst;
  };
  EXPECT_GT(error_cm({}), 1);
  EXPECT_LT(error_cm({.time = TimeAlignment::kFixed, .offset_s = -0.5}), 1e-6);
  EXPECT_LT(error_cm({.time = TimeAlignment::kCorrelate}), 0.5);
  EXPECT_GT(error_cm({.time = TimeAlignment::kFixed, .offset_s = 0.5}), 1);
  EXPECT_NEAR(PairUp(truth, late, {.time = TimeAlignment::kCorrelate})[0].offset_s, -0.5, 0.02);
}

// Two people beside each other, the second moving in reverse.
SkeletonSequence TwoPeople() {
  auto two = Swinging(90, 1 / 30.0);
  const auto one = two;
  for (size_t f = 0; f < two.frames.size(); ++f) {
    BodyRecord other = one.frames[one.frames.size() - 1 - f].bodies[0];
    other.id = 2;
    for (auto& joint : other.joints) joint->position_m.x() += 3.0;
    two.frames[f].bodies.push_back(other);
  }
  return two;
}

SkeletonSequence MovedBy(const Eigen::Isometry3d& to_from, SkeletonSequence sequence) {
  for (auto& frame : sequence.frames) {
    for (BodyRecord& body : frame.bodies) {
      for (auto& joint : body.joints) joint->position_m = to_from * joint->position_m;
    }
  }
  return sequence;
}

// Seen from behind, where the two have exchanged places.
TEST(SeveralPeople, AreMatchedAfterRigidAlignmentOfAResultInAnotherSpace) {
  const auto truth = TwoPeople();
  const Eigen::Isometry3d behind = Eigen::Translation3d(4.9, 0.0, 4.0) *
                                   Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()) *
                                   Eigen::Isometry3d::Identity();
  const auto pairs = PairUp(truth, MovedBy(behind, truth), {.rigid = true});
  ASSERT_EQ(pairs.size(), 2u);
  for (const auto& pair : pairs) EXPECT_NEAR(*Measure(pair).mean_joint_error_cm, 0, 1e-6);
}

TEST(OnePerson, IsPairedWithAFalseBodyPresentInAnotherSpace) {
  const auto truth = Swinging(90, 1 / 30.0);
  auto haunted = truth;  // a false body that stands still
  for (auto& frame : haunted.frames) {
    BodyRecord ghost = truth.frames[0].bodies[0];
    ghost.id = 7;
    frame.bodies.push_back(ghost);
    for (auto& joint : frame.bodies[0].joints) joint->position_m.x() += 2.0;
  }
  const auto pairs = PairUp(truth, haunted, {.rigid = true});
  EXPECT_NEAR(*Measure(pairs.at(0)).mean_joint_error_cm, 0, 1e-6);
}

TEST(MeanOverClips, WeighsShortAndLongClipsEqually) {
  ClipMetrics one;
  one.frames = 10;
  one.mean_joint_error_cm = 2;
  ClipMetrics other;
  other.frames = 1000;
  other.mean_joint_error_cm = 4;
  other.map_10cm = 0.5;
  const ClipMetrics mean = MeanOverClips("both", {one, other});
  EXPECT_EQ(mean.frames, 1010);
  EXPECT_EQ(*mean.mean_joint_error_cm, 3);
  EXPECT_EQ(*mean.map_10cm, 0.5);
  EXPECT_FALSE(mean.p99_cm.has_value());
}

TEST(SharedValues, AreOfClipsForWhichEveryResultHasAValue) {
  const auto clip = [](const char* name, std::optional<double> error_cm) {
    ClipMetrics metrics;
    metrics.name = name;
    metrics.mean_joint_error_cm = error_cm;
    return metrics;
  };
  const auto values = SharedValues(
      {{clip("a", 1), clip("b", 2), clip("c", 3)}, {clip("a", 4), clip("b", {}), clip("c", 6)}},
      &ClipMetrics::mean_joint_error_cm);
  EXPECT_EQ(values, (std::vector<std::vector<double>>{{1, 3}, {4, 6}}));
}

}  // namespace
}  // namespace ossa::tools
