#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "forest/proposals/modes_internal.h"

namespace ossa::forest {
namespace {

constexpr size_t kSamples = 13;  // no multiple of what is computed side by side

// One class and one target; sample i votes for a place i · 10 cm to the side and 5 cm down, the
// last for none.
Evidence SomeEvidence() {
  Evidence evidence;
  evidence.class_count = 2;
  evidence.count = kSamples;
  const size_t stride = PaddedToLanes(kSamples);
  for (auto* values : {&evidence.x_m, &evidence.y_m, &evidence.z_m, &evidence.distance_m,
                       &evidence.area_m2, &evidence.probability}) {
    values->resize(stride);
  }
  evidence.probability.resize(2 * stride);
  evidence.votes.resize(stride);
  for (size_t i = 0; i < kSamples; ++i) {
    const auto n = static_cast<float>(i);
    evidence.x_m[i] = 0.1F * n;
    evidence.z_m[i] = 2.0F;
    evidence.distance_m[i] = evidence.surface_m(i).norm();
    evidence.area_m2[i] = 1e-4F * (1.0F + n);
    evidence.probability[stride + i] = n / kSamples;
    evidence.votes[i] = {{static_cast<int8_t>(-10 * static_cast<int>(i)), -5, 0},
                         static_cast<uint8_t>(i % 3)};
  }
  evidence.votes[kSamples - 1].spread_cm = Vote::kNone;
  return evidence;
}

ProposalTarget Target(float vote_radius_m) {
  ProposalTarget target;
  target.classes = {1};
  target.class_weight = 0.0F;
  target.vote_radius_m = vote_radius_m;
  return target;
}

TEST(GatherPoints, SumsVotesWithinTheRadius) {
  const Evidence evidence = SomeEvidence();
  float total = 0.0F;
  for (size_t i = 0; i < kSamples - 1; ++i) {
    const Vote& vote = evidence.votes[i];
    if (std::hypot(vote.offset_cm[0], vote.offset_cm[1]) > 70) continue;
    const float relative = 0.01F * static_cast<float>(vote.spread_cm) / 0.06F;
    total += evidence.area_m2[i] / std::pow(1.0F + relative * relative, 2.0F);
  }
  const TargetPoints points = GatherPoints(evidence, Target(0.7F), 0);
  EXPECT_NEAR(points.vote_total, total, 1e-9F);  // rounding of seven floats below 1e-3
  // Each of them says the same place.
  ASSERT_GT(points.points.size(), 0U);
  EXPECT_NEAR(points.points.at(0).x(), 0.0F, 1e-6F);
  EXPECT_NEAR(points.points.at(0).y(), -0.05F, 1e-6F);
  EXPECT_NEAR(points.points.at(0).z(), 2.0F, 1e-6F);
}

TEST(GatherPoints, AcceptsAVoteAsLongAsTheRadius) {
  Evidence evidence = SomeEvidence();
  for (Vote& vote : evidence.votes) vote = {{0, 0, 0}, Vote::kNone};
  evidence.votes[4] = {{0, 0, 70}, 2};
  const float length_m = 0.01F * 70.0F;  // as votes are read
  EXPECT_EQ(GatherPoints(evidence, Target(length_m), 0).points.size(), 1U);
  EXPECT_EQ(GatherPoints(evidence, Target(std::nextafter(length_m, 0.0F)), 0).points.size(), 0U);
}

TEST(GatherPoints, NegativeRadiusAcceptsNoVotes) {
  EXPECT_EQ(GatherPoints(SomeEvidence(), Target(-1.0F), 0).points.size(), 0U);
}

TEST(GatherPoints, UsesSurfacesOfItsClassesPushedIntoTheBody) {
  ProposalTarget target = Target(0.0F);
  target.class_weight = 0.5F;
  target.probability_threshold = 0.5F;
  target.push_back_m = 0.04F;
  const TargetPoints points = GatherPoints(SomeEvidence(), target, 0);
  ASSERT_EQ(points.surface.size(), 6U);  // samples 7 to 12 of 13
  const Eigen::Vector3f seen(0.7F, 0.0F, 2.0F);
  EXPECT_NEAR((points.surface.at(0) - seen).norm(), 0.04F, 1e-6F);
  EXPECT_NEAR((points.surface.at(0) - seen).cross(seen).norm(), 0.0F, 1e-6F);
  EXPECT_FLOAT_EQ(points.points.weight[0], 0.5F * points.surface.weight[0]);
}

}  // namespace
}  // namespace ossa::forest
