// Bones of the skeletons that come out in the end, whatever holds their joints to the image.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "recon/normalise.h"
#include "tests/support/capsule_person.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

using recon::kJointCount;
using recon::TrackingState;

// How far, of all frames and bones, a final bone is from what it was at first, as a share of it,
// when the joints of somebody who stands are seen centimetres off and the left arm only guessed.
// Where bones are judged, each frame's by a hundredth or two otherwise, `settled` is the first.
double WorstDrift(const SkeletonOptions& options, int settled = 0) {
  tests::CapsuleRender render = Rendered({PersonAt(0.0, 2.5)});
  std::mt19937_64 random(3);
  std::normal_distribution<double> off_m(0.0, 0.04), over(1.05, 0.015);
  Person person;
  recon::BoneLengths first{};
  double worst = 0.0;
  for (int f = 0; f < 100; ++f) {
    Body body;
    body.raw.posture = render.joints.front();
    body.raw.state.fill(TrackingState::kTracked);
    body.raw.confidence.fill(1.0);
    for (size_t j = 0; j < kJointCount; ++j) {
      for (double& x : body.raw.posture.position_m[j]) x += off_m(random);
      if (j >= 4 && j < 8) body.raw.state[j] = TrackingState::kInferred;
    }
    if (settled > 0) {
      body.refined_bones_m = recon::StandardBoneLengths();
      for (double& length_m : *body.refined_bones_m) length_m *= over(random);
    }
    render.frame.time_s = f / 30.0;
    StageTimes ms;
    const std::optional<Eigen::Vector4d> floor;
    SkeletonWork work{options, render.frame, floor, nullptr, person, body};
    CompleteSkeleton(work, ms);
    person.before_s = render.frame.time_s;
    const recon::BoneLengths lengths = recon::MeasureBoneLengths(ToPosture(body));
    if (f == settled) first = lengths;
    for (size_t j = 1; f > settled && j < kJointCount; ++j) {
      worst = std::max(worst, std::abs(lengths[j] / first[j] - 1.0));
    }
  }
  return worst;
}

SkeletonOptions Unsmoothed(const std::string& method) {
  SkeletonOptions options;
  options.reconstructor.method = method;
  options.smoothing = SmoothingPreset("none");
  return options;
}

TEST(FinalBones, StayConstantWithFreeSpaceConstraints) {
  EXPECT_LT(WorstDrift(Unsmoothed("best")), 0.001);
}

TEST(FinalBones, EqualThoseOfThePhysicalCharacter) {
  SkeletonOptions options = Unsmoothed("best");
  options.physics = true;
  EXPECT_LT(WorstDrift(options), 0.001);
}

TEST(FinalBones, SettleWithNetworkEstimates) {
  SkeletonOptions options = Unsmoothed("best");
  EXPECT_GT(WorstDrift(options, 1), 0.001);
  // Later than in a second: frames with too many odd joints count for nothing.
  EXPECT_LT(WorstDrift(options, 60), 0.001);
  options.physics = true;  // whose character is made anew a while after
  EXPECT_LT(WorstDrift(options, 75), 0.001);
}

TEST(FinalBones, StayConstantUnderSmoothing) {
  SkeletonOptions options = Unsmoothed("best");
  options.smoothing = SmoothingPreset("verysmooth");
  EXPECT_LT(WorstDrift(options), 0.001);
}

TEST(FinalBones, EqualTheObservationWithoutReconstruction) {
  EXPECT_GT(WorstDrift(Unsmoothed("none")), 0.1);
}

// What leaves the character does not go back into the floor or the chest, however surely joints are
// seen there.
TEST(Physics, FloorAndChestContainTheLimbs) {
  tests::CapsuleRender render = Rendered({PersonAt(0.0, 2.5)});
  SkeletonOptions options = Unsmoothed("none");
  options.physics = true;
  const std::optional<Eigen::Vector4d> floor = Eigen::Vector4d(0.0, 1.0, 0.0, 1.0);
  Person person;
  Body body;
  for (int f = 0; f < 60; ++f) {
    body = {};
    body.raw.posture = render.joints.front();
    body.raw.state.fill(TrackingState::kTracked);
    body.raw.confidence.fill(1.0);
    for (const auto joint : {recon::Joint::kAnkleLeft, recon::Joint::kFootLeft}) {
      body.raw.posture[joint].y() -= 0.12;
    }
    const Eigen::Vector3d chest = 0.5 * (body.raw.posture[recon::Joint::kSpine] +
                                         body.raw.posture[recon::Joint::kShoulderCenter]);
    body.raw.posture[recon::Joint::kWristRight] = chest;
    render.frame.time_s = f / 30.0;
    StageTimes ms;
    SkeletonWork work{options, render.frame, floor, nullptr, person, body};
    CompleteSkeleton(work, ms);
    person.before_s = render.frame.time_s;
  }
  const recon::Posture out = ToPosture(body);
  for (const Eigen::Vector3d& p : out.position_m) EXPECT_GT(p.y(), -1.0 + 0.02);  // a sole's height
  const Eigen::Vector3d trunk = (out[recon::Joint::kShoulderCenter] - out[recon::Joint::kSpine]);
  const Eigen::Vector3d wrist = out[recon::Joint::kWristRight] - out[recon::Joint::kSpine];
  EXPECT_GT(wrist.cross(trunk.normalized()).norm(), 0.1);  // chest and forearm less 3 cm of skin
}

}  // namespace
}  // namespace ossa::tracker
