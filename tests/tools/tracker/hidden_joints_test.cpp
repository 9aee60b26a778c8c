#include "recon/refine/free_space.h"
#include "tests/support/capsule_person.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

constexpr auto kHand = recon::Index(recon::Joint::kHandLeft);

// Somebody whose left hand is said to be 30 cm before the body, where the camera looks through it
// at the wall.
struct HandInTheAir {
  tests::CapsuleRender render = Rendered({PersonAt(0.0, 2.5)});
  Body body;
  SkeletonOptions options;
  Person person;

  explicit HandInTheAir(recon::TrackingState state) {
    options.reconstructor.method = "none";
    options.smoothing = SmoothingPreset("none");
    body.raw.posture = render.joints.front();
    body.raw.state.fill(recon::TrackingState::kTracked);
    body.raw.confidence.fill(1.0);
    body.raw.posture.position_m[kHand] += Eigen::Vector3d(0.15, 0.0, -0.3);
    body.raw.state[kHand] = state;
  }

  const Eigen::Vector3d& Hand(int frames) {
    StageTimes ms;
    const std::optional<Eigen::Vector4d> floor;
    for (int f = 0; f < frames; ++f) {
      render.frame.time_s = f / 30.0;
      SkeletonWork work{options, render.frame, floor, nullptr, person, body};
      CompleteSkeleton(work, ms);
      person.before_s = render.frame.time_s;
    }
    return body.joints[kHand].position_m;
  }
};

TEST(HiddenJoints, AreNotLeftWhereTheCameraLooksThroughThem) {
  HandInTheAir scene(recon::TrackingState::kInferred);
  const Eigen::Vector3d said = scene.body.raw.posture.position_m[kHand];
  ASSERT_TRUE(recon::IsInFreeSpace(said, scene.render.frame));
  EXPECT_FALSE(recon::IsInFreeSpace(scene.Hand(10), scene.render.frame));
  EXPECT_EQ(scene.body.raw.posture.position_m[kHand], said) << "raw is what was inferred";
}

TEST(HiddenJoints, ThatAreSeenAgainStayWhereTheyAreSeen) {
  HandInTheAir scene(recon::TrackingState::kInferred);
  scene.Hand(10);
  scene.body.raw.state[kHand] = recon::TrackingState::kTracked;
  EXPECT_LT((scene.Hand(1) - scene.body.raw.posture.position_m[kHand]).norm(), 0.061);
}

}  // namespace
}  // namespace ossa::tracker
