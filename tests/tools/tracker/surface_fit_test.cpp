// The tracker with a surface fit: the shipped body, the shipped forest.
#include <gtest/gtest.h>

#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa::tracker {
namespace {

BodyFrame LastOf(const TrackerOptions& options, const std::vector<tests::CapsulePose>& people) {
  Tracker tracker(options);
  BodyFrame result;
  for (int i = 0; i < 15; ++i) result = tracker.Track(Rendered(people, i).frame);
  return result;
}

TrackerOptions Fitting(int threads = 1) {
  TrackerOptions options;
  options.threads = threads;
  return options;
}

TEST(TrackedSurface, IsReturnedBesideTheOtherStagesAndExplainsThePixels) {
  OSSA_NEEDS_MODEL();
  const BodyFrame seen = LastOf(Fitting(), {PersonAt(0, 2.5)});
  ASSERT_EQ(seen.bodies.size(), 1U);
  ASSERT_TRUE(seen.bodies[0].fit);
  EXPECT_GT(seen.bodies[0].fit->explained, 0.6);
  EXPECT_GT(seen.ms.fit, 0.0);
}

// The bones of whoever comes in are what the fit and the network say of the first frame.
TEST(TrackedSurface, CombinesItsBonesWithTheNetworks) {
  OSSA_NEEDS_MODEL();
  Tracker tracker(Fitting());
  BodyFrame seen;
  for (int i = 0; i < 15 && seen.bodies.empty(); ++i) {
    seen = tracker.Track(Rendered({PersonAt(0, 2.5)}, i).frame);
  }
  ASSERT_EQ(seen.bodies.size(), 1U);
  const Body& body = seen.bodies[0];
  ASSERT_TRUE(body.fit && body.refined_bones_m && body.bones_m);
  const recon::BoneLengths fitted_m = recon::MeasureBoneLengths(body.fit->joints_m);
  for (size_t j = 1; j < recon::kJointCount; ++j) {
    const double judged_m = 0.7 * fitted_m[j] + 0.3 * (*body.refined_bones_m)[j];
    EXPECT_NEAR((*body.bones_m)[j], judged_m, 1e-9) << j;
  }
}

TEST(TrackedSurface, IsEmptyIfSwitchedOff) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options;
  options.fit.reset();
  const BodyFrame seen = LastOf(options, {PersonAt(0, 2.5)});
  ASSERT_EQ(seen.bodies.size(), 1U);
  EXPECT_FALSE(seen.bodies[0].fit);
}

TEST(TrackedSurface, IsTheSameOnAnyNumberOfThreads) {
  OSSA_NEEDS_MODEL();
  const std::vector<tests::CapsulePose> people = {PersonAt(-0.7, 2.5), PersonAt(0.7, 2.8)};
  const BodyFrame one = LastOf(Fitting(1), people), two = LastOf(Fitting(2), people);
  ASSERT_EQ(one.bodies.size(), two.bodies.size());
  for (size_t i = 0; i < one.bodies.size(); ++i) {
    ASSERT_TRUE(one.bodies[i].fit && two.bodies[i].fit);
    EXPECT_EQ(one.bodies[i].shape->vote, two.bodies[i].shape->vote);
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      EXPECT_EQ(one.bodies[i].joints[j].position_m, two.bodies[i].joints[j].position_m);
      EXPECT_EQ(one.bodies[i].fit->covariance_m2[j], two.bodies[i].fit->covariance_m2[j]);
    }
  }
}

// What explains its pixels badly is believed less; what has none stays as it was.
TEST(TrackedSurface, LowersTheReliabilityOfJointsFarFromTheirPixels) {
  OSSA_NEEDS_MODEL();
  TrackerOptions trusting = Fitting(), doubting = Fitting();
  doubting.fit->doubt_residual_m = 0.02;
  const std::vector<tests::CapsulePose> people = {PersonAt(0, 2.5)};
  const Body trusted = LastOf(trusting, people).bodies.at(0);
  const Body doubted = LastOf(doubting, people).bodies.at(0);
  double trusted_sum = 0.0, doubted_sum = 0.0;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    trusted_sum += trusted.joints[j].reliability;
    doubted_sum += doubted.joints[j].reliability;
  }
  EXPECT_LT(doubted_sum, trusted_sum);
}

TEST(TrackedSurface, StartsFromAKnownShape) {
  OSSA_NEEDS_MODEL();
  TrackerOptions options = Fitting();
  const auto told = LastOf(options, {PersonAt(0, 2.5)}).bodies.at(0).shape;
  ASSERT_TRUE(told);
  options.shapes[1] = *told;
  Tracker tracker(options);
  const BodyFrame first = tracker.Track(Rendered({PersonAt(0, 2.5)}, 0).frame);
  ASSERT_EQ(first.bodies.size(), 1U);
  ASSERT_TRUE(first.bodies[0].shape);
  EXPECT_EQ(first.bodies[0].shape->frames, told->frames + 1);
  EXPECT_LT((first.bodies[0].shape->shape - told->shape).norm(), 0.1 * told->shape.norm());
}

TEST(TrackedSurface, IsEmptyWithoutABodyModelOrRefinedJoints) {
  OSSA_NEEDS_MODEL();
  ModelFiles bodiless, unrefined;
  bodiless.surface = "none";
  unrefined.refinement = "none";
  for (const ModelFiles& files : {bodiless, unrefined}) {
    const BodyFrame seen = LastOf(OptionsWith(files), {PersonAt(0, 2.5)});
    ASSERT_EQ(seen.bodies.size(), 1U);
    EXPECT_FALSE(seen.bodies[0].fit);
  }
}

}  // namespace
}  // namespace ossa::tracker
