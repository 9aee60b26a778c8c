// How the bones of the database's posture are turned about themselves reaches the skeleton.
#include <gtest/gtest.h>

#include <cmath>

#include "recon/body/standard_body.h"
#include "recon/database/posture_database.h"
#include "recon/orientation.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

constexpr double kTwist_rad = 0.9;
constexpr size_t kForearm = recon::Index(recon::Joint::kWristLeft);

/// One standing posture of the rig, its left forearm turned about itself.
std::shared_ptr<const recon::PostureDatabase> TwistedDatabase() {
  using recon::Joint;
  const recon::Posture rest = recon::StandardPosture(recon::RigPose{});
  recon::RigPose pose;
  for (const char* bone : {"LeftForeArm", "LeftHand"}) {
    pose.world_from_rest[recon::RigBone(bone)] = Eigen::AngleAxisd(
        kTwist_rad, (rest[Joint::kWristLeft] - rest[Joint::kElbowLeft]).normalized());
  }
  recon::PostureClip clip{"twisted", {rest}, {recon::ComputeOrientations(pose)}};
  return std::make_shared<recon::PostureDatabase>(recon::PostureDatabase::Build({clip}, {}));
}

/// How far the skeleton's left forearm is turned about itself from what its joints tell.
double TwistOfTheSkeleton_rad(bool physics) {
  tests::CapsuleRender render = Rendered({PersonAt(0.0, 2.5)});
  SkeletonOptions options;
  options.reconstructor.method = "shum-ho-2012";
  options.reconstructor.database = TwistedDatabase();
  options.smoothing = SmoothingPreset("none");
  options.physics = physics;
  Person person;
  Body body;
  body.raw.posture = render.joints.front();
  body.raw.state.fill(recon::TrackingState::kTracked);
  body.raw.confidence.fill(1.0);
  StageTimes ms;
  const std::optional<Eigen::Vector4d> floor;
  for (int f = 0; f < 30; ++f) {
    render.frame.time_s = f / 30.0;
    SkeletonWork work{options, render.frame, floor, nullptr, person, body};
    CompleteSkeleton(work, ms);
  }
  recon::Posture made;
  for (size_t j = 0; j < recon::kJointCount; ++j) made.position_m[j] = body.joints[j].position_m;
  const Eigen::Vector3d x = recon::ComputeOrientations(made)[kForearm].conjugate() *
                            (body.joints[kForearm].orientation * Eigen::Vector3d::UnitX());
  return std::atan2(-x.z(), x.x());
}

// Joints tell a forearm's turn by its parents' alone: no closer than the capsule person's arms hang
// like the rig's, some 10 degrees.
TEST(BoneTurns, DatabaseTwistReachesTheSkeleton) {
  EXPECT_NEAR(TwistOfTheSkeleton_rad(false), kTwist_rad, 0.25);
}

TEST(BoneTurns, DatabaseTwistReachesTheSkeletonThroughTheCharacter) {
  EXPECT_NEAR(TwistOfTheSkeleton_rad(true), kTwist_rad, 0.35);
}

}  // namespace
}  // namespace ossa::tracker
