#include <gtest/gtest.h>

#include <cmath>

#include "tools/experiments/real/steadiness_internal.h"

namespace ossa::tools {
namespace {

const auto kHead = static_cast<size_t>(recon::Joint::kHead);

// A body at rest, equal in all stages, whose head is this far from its mean position.
BodyStages WithHeadAt(const Eigen::Vector3d& offset_m) {
  StageJoints joints;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    joints[j] = Eigen::Vector3d(0, 0.1 * static_cast<double>(j), 2);
  }
  *joints[kHead] += offset_m;
  BodyStages body;
  for (const RealStage stage : kRealStages) body[stage] = joints;
  return body;
}

BodyStages WithoutHead() {
  BodyStages body = WithHeadAt({0, 0, 0});
  for (auto& [stage, joints] : body) joints[kHead].reset();
  return body;
}

Steadiness Watch(const std::vector<BodyStages>& frames) {
  Steadiness steadiness;
  for (const BodyStages& body : frames) steadiness.Add({{1, body}});
  return steadiness;
}

double FinalLeaps(const std::vector<BodyStages>& frames) {
  return Watch(frames).CountLeaps().at(RealStage::kFinal);
}

TEST(Steadiness, MoreThanHalfAMetrePerFrameIsAJump) {
  EXPECT_EQ(FinalLeaps({WithHeadAt({0, 0, 0}), WithHeadAt({0.49, 0, 0})}), 0.0);
  EXPECT_EQ(FinalLeaps({WithHeadAt({0, 0, 0}), WithHeadAt({0.51, 0, 0})}), 50.0);
}

TEST(Steadiness, AbsentJointDoesNotJump) {
  EXPECT_EQ(FinalLeaps({WithHeadAt({0, 0, 0}), WithoutHead(), WithHeadAt({1, 0, 0})}), 0.0);
}

TEST(Steadiness, ReturningPersonDoesNotJump) {
  Steadiness steadiness;
  steadiness.Add({{1, WithHeadAt({0, 0, 0})}});
  steadiness.Add({});
  steadiness.Add({{1, WithHeadAt({1, 0, 0})}});
  EXPECT_EQ(steadiness.CountLeaps()[RealStage::kFinal], 0.0);
}

TEST(Steadiness, EachBodyIsComparedWithItsOwnPreviousFrame) {
  Steadiness steadiness;
  for (int frame = 0; frame < 2; ++frame) {
    steadiness.Add({{1, WithHeadAt({0, 0, 0})}, {2, WithHeadAt({1, 0, 0})}});
  }
  EXPECT_EQ(steadiness.CountLeaps().at(RealStage::kFinal), 0.0);
}

// Of 20 joints one is 2 mm off its mean in each of six frames, to and fro.
TEST(Steadiness, JitterIsTheRootMeanSquareDistanceOfStillJointsFromTheirMean) {
  std::vector<BodyStages> frames;
  for (int frame = 0; frame < 6; ++frame) {
    frames.push_back(WithHeadAt({0, 0, frame % 2 == 0 ? 0.002 : -0.002}));
  }
  EXPECT_NEAR(Watch(frames).MeasureJitter().at(RealStage::kFinal), 2.0 / std::sqrt(20.0), 1e-9);
}

TEST(Steadiness, JointsThatMoveHaveNoJitter) {
  std::vector<BodyStages> frames;
  for (int frame = 0; frame < 6; ++frame) frames.push_back(WithHeadAt({0.1 * frame, 0, 0}));
  EXPECT_NEAR(Watch(frames).MeasureJitter().at(RealStage::kFinal), 0.0, 1e-9);  // of the 19 others
}

// Final joints without the head: of the 19 others, which do not move at all.
TEST(Steadiness, StageWithoutAJointHasNoJitterOfIt) {
  std::vector<BodyStages> frames;
  for (int frame = 0; frame < 6; ++frame) {
    frames.push_back(WithHeadAt({0, 0, frame % 2 == 0 ? 0.002 : -0.002}));
    frames.back()[RealStage::kFinal][kHead].reset();
  }
  const auto jitter_mm = Watch(frames).MeasureJitter();
  EXPECT_NEAR(jitter_mm.at(RealStage::kFinal), 0.0, 1e-9);  // rounding
  EXPECT_NEAR(jitter_mm.at(RealStage::kRaw), 2.0 / std::sqrt(20.0), 1e-9);
}

// One bone, the head's, is 1 % longer, then 1 % shorter than its mean.
TEST(Steadiness, BonesVaryByTheStandardDeviationOverTheMean) {
  const auto along = [](double factor) {
    BodyStages body = WithHeadAt({0, 0, 0});
    for (auto& [stage, joints] : body) {
      const Eigen::Vector3d parent = *joints[recon::ParentOf(kHead)];
      joints[kHead] = parent + factor * Eigen::Vector3d(0, 0, 0.2);
    }
    return body;
  };
  const auto variation = Watch({along(0.99), along(1.01)}).MeasureBoneVariation();
  const double of_one = 100 * 0.01 * std::sqrt(2.0);  // per cent; n - 1 in the deviation
  EXPECT_NEAR(variation.at(RealStage::kFinal), of_one / (recon::kJointCount - 1), 1e-9);
}

}  // namespace
}  // namespace ossa::tools
