// Somebody who lies or sits on the floor has no joint below it.
#include "recon/body/standard_body.h"
#include "recon/t_pose.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

using recon::Index;
using recon::Joint;
using recon::kJointCount;

constexpr double kCamera_m = 1.2;    // over the floor
constexpr double kLowest_m = -0.03;  // that a joint may be below it

// Legs down, the hips at a height: on the floor they go through it.
class OnTheFloor : public testing::Test {
 protected:
  OnTheFloor() { detection_.age = 20; }
  recon::Posture PostureAt(double hips_m) {
    recon::Posture posture =
        recon::BuildTPose(recon::MeasureBoneLengths(recon::StandardPosture(recon::RigPose{})));
    const Eigen::Vector3d move_m(0.4, hips_m - kCamera_m - posture[Joint::kHipCenter].y(), 3.0);
    for (auto& joint_m : posture.position_m) joint_m += move_m;
    return posture;
  }
  recon::Posture Keep(const recon::Posture& posture) {
    SkeletonWork work{options_, frame_, floor_, &detection_, person_, body_};
    work.posture = posture;
    work.seen = seen_;
    KeepAboveFloor(work);
    return work.posture;
  }
  static double Height_m(const recon::Posture& posture, size_t joint) {
    return posture.position_m[joint].y() + kCamera_m;
  }

  SkeletonOptions options_;
  depth::DepthFrame frame_;
  std::optional<Eigen::Vector4d> floor_ = Eigen::Vector4d(0.0, 1.0, 0.0, kCamera_m);
  people::Detection detection_;
  Person person_;
  Body body_;
  recon::TrackedPosture seen_;  // no joint is seen
};

TEST_F(OnTheFloor, LegsAreTurnedUpAndKeepTheirLengths) {
  for (const double hips_m : {0.1, -0.1}) {
    const recon::Posture before = PostureAt(hips_m), made = Keep(before);
    for (size_t j = 1; j < kJointCount; ++j) {
      EXPECT_GT(Height_m(made, j), kLowest_m - 1e-9) << j;
      const auto length_m = [&](const recon::Posture& posture) {
        return (posture.position_m[j] - posture.position_m[recon::ParentOf(j)]).norm();
      };
      EXPECT_NEAR(length_m(made), length_m(before), 1e-9) << j;
    }
  }
}

TEST_F(OnTheFloor, JointsAboveItStayWhereTheyAre) {
  const recon::Posture before = PostureAt(0.1), made = Keep(before);
  for (size_t j = 0; j <= Index(Joint::kHandRight); ++j) {
    EXPECT_EQ(made.position_m[j], before.position_m[j]) << j;
  }
}

TEST_F(OnTheFloor, SeenJointsBelowItProveItWrong) {
  seen_.state[Index(Joint::kKneeLeft)] = recon::TrackingState::kTracked;
  const recon::Posture before = PostureAt(0.1);
  EXPECT_EQ(Keep(before).position_m, before.position_m);
}

TEST_F(OnTheFloor, NotInTheFirstFramesWhoseFloorMayBeATableTop) {
  detection_.age = 1;
  const recon::Posture before = PostureAt(0.1);
  EXPECT_EQ(Keep(before).position_m, before.position_m);
}

TEST_F(OnTheFloor, WhoStandsOrSitsBehindATableTopIsNotChanged) {
  for (const double hips_m : {0.6, -0.3}) {
    const recon::Posture before = PostureAt(hips_m);
    EXPECT_EQ(Keep(before).position_m, before.position_m) << hips_m;
  }
  floor_.reset();
  const recon::Posture before = PostureAt(0.1);
  EXPECT_EQ(Keep(before).position_m, before.position_m);
}

}  // namespace
}  // namespace ossa::tracker
