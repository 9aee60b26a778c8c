#include <gtest/gtest.h>

#include <random>

#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/motion/bvh.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

/// A body of constant bone lengths whose bones point anywhere, at 30 frames a second.
SkeletonSequence RandomMotion(int frames, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const BoneLengths lengths = MeasureBoneLengths(StandardPosture(RigPose()));
  SkeletonSequence sequence{"random.jsonl", {}};
  for (int f = 0; f < frames; ++f) {
    SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = 7.0 + f / 30.0;
    BodyRecord body;
    body.id = 4;
    for (size_t j = 0; j < kJointCount; ++j) {
      JointRecord joint;
      joint.position_m = Eigen::Vector3d(0.1 * f, 0.5, 2.0);
      if (j > 0) {
        const Eigen::Vector3d direction(normal(random), normal(random), normal(random));
        joint.position_m =
            body.joints[ParentOf(j)]->position_m + lengths[j] * direction.normalized();
      }
      body.joints[j] = joint;
    }
    frame.bodies.push_back(body);
    sequence.frames.push_back(frame);
  }
  return sequence;
}

double WorstDistance_m(const SkeletonSequence& a, const SkeletonSequence& b) {
  double worst = 0.0;
  for (size_t f = 0; f < a.frames.size(); ++f) {
    for (size_t j = 0; j < kJointCount; ++j) {
      worst = std::max(worst, (a.frames[f].bodies[0].joints[j]->position_m -
                               b.frames[f].bodies[0].joints[j]->position_m)
                                  .norm());
    }
  }
  return worst;
}

TEST(SkeletonToBvh, ReproducesJointsOfConstantBoneLengths) {
  const SkeletonSequence truth = RandomMotion(20, 5);
  const std::string text = FormatBvh(SkeletonToBvh(truth));
  const SkeletonSequence back = BvhToSkeleton(ParseBvh(text, "back.bvh"), "back.bvh");
  ASSERT_EQ(back.frames.size(), truth.frames.size());
  // Six decimals of a degree over at most 1 m of chain, and of a centimetre.
  EXPECT_LT(WorstDistance_m(truth, back), 1e-6);
}

TEST(SkeletonToBvh, HasConstantBoneLengths) {
  SkeletonSequence noisy = RandomMotion(30, 6);
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 0.02);
  for (SkeletonFrame& frame : noisy.frames) {
    for (auto& joint : frame.bodies[0].joints) {
      joint->position_m += Eigen::Vector3d(noise(random), noise(random), noise(random));
    }
  }
  const SkeletonSequence back = BvhToSkeleton(SkeletonToBvh(noisy), "back");
  std::optional<BoneLengths> first;
  for (const SkeletonFrame& frame : back.frames) {
    const BoneLengths lengths = MeasureBoneLengths(ToTrackedPosture(frame.bodies[0]).posture);
    if (!first) first = lengths;
    for (size_t j = 1; j < kJointCount; ++j) EXPECT_NEAR(lengths[j], (*first)[j], 1e-9);
  }
  // 2 cm of noise a coordinate is 3.5 cm a joint; bone directions are kept, so a joint may add up
  // the length errors of its chain.
  EXPECT_LT(WorstDistance_m(noisy, back), 0.25);
}

TEST(SkeletonToBvh, MissingJointsKeepTheirLastDirection) {
  SkeletonSequence sequence = RandomMotion(3, 8);
  sequence.frames[1].bodies[0].joints[Joint::kHandLeft].reset();
  const SkeletonSequence back = BvhToSkeleton(SkeletonToBvh(sequence), "back");
  const auto hand = [&](const SkeletonSequence& s, size_t f) {
    const Posture p = ToTrackedPosture(s.frames[f].bodies[0]).posture;
    return Eigen::Vector3d((p[Joint::kHandLeft] - p[Joint::kWristLeft]).normalized());
  };
  EXPECT_LT((hand(back, 1) - hand(sequence, 0)).norm(), 1e-6);
  EXPECT_LT((hand(back, 2) - hand(sequence, 2)).norm(), 1e-6);
}

TEST(SkeletonToBvh, GapsInTimeBecomeEvenFrames) {
  SkeletonSequence sequence = RandomMotion(10, 9);
  sequence.frames.erase(sequence.frames.begin() + 3, sequence.frames.begin() + 6);
  EXPECT_EQ(SkeletonToBvh(sequence).FrameCount(), 10u);
}

TEST(SkeletonToBvh, ConvertsTheRequestedBodyAndRefusesAMissingOne) {
  BvhExportOptions options;
  options.body_id = 4;
  EXPECT_EQ(SkeletonToBvh(RandomMotion(2, 1), options).FrameCount(), 2u);
  options.body_id = 5;
  EXPECT_THROW(SkeletonToBvh(RandomMotion(2, 1), options), InputError);
  EXPECT_THROW(SkeletonToBvh(SkeletonSequence{"empty", {}}), InputError);
}

TEST(BvhWriter, WritesWhatTheReaderReads) {
  const BvhFile bvh = SkeletonToBvh(RandomMotion(5, 2));
  test::TemporaryFolder folder;
  WriteBvh(bvh, folder.path() / "x.bvh");
  const BvhFile back = ReadBvh(folder.path() / "x.bvh");
  ASSERT_EQ(back.joints.size(), bvh.joints.size());
  ASSERT_EQ(back.values.size(), bvh.values.size());
  for (size_t i = 0; i < bvh.values.size(); ++i) EXPECT_NEAR(back.values[i], bvh.values[i], 1e-6);
  for (size_t j = 0; j < bvh.joints.size(); ++j) EXPECT_EQ(back.joints[j].name, bvh.joints[j].name);
}

}  // namespace
}  // namespace ossa::recon
