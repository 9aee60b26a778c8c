#include "recon/refine/free_space.h"
#include "tests/support/capsule_person.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

constexpr auto kHand = recon::Index(recon::Joint::kHandLeft);
constexpr auto kWrist = recon::Index(recon::Joint::kWristLeft);

// A person whose left hand is estimated 30 cm in front of the body, where the camera sees the wall
// behind.
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
    for (int f = 0; f < frames; ++f) Step(f / 30.0);
    return body.joints[kHand].position_m;
  }

  void Step(double time_s) {
    StageTimes ms;
    const std::optional<Eigen::Vector4d> floor;
    render.frame.time_s = time_s;
    SkeletonWork work{options, render.frame, floor, nullptr, person, body};
    CompleteSkeleton(work, ms);
    person.before_s = time_s;
  }
};

TEST(HiddenJoints, AreMovedOutOfFreeSpace) {
  HandInTheAir scene(recon::TrackingState::kInferred);
  const Eigen::Vector3d said = scene.body.raw.posture.position_m[kHand];
  ASSERT_TRUE(recon::IsInFreeSpace(said, scene.render.frame));
  EXPECT_FALSE(recon::IsInFreeSpace(scene.Hand(10), scene.render.frame));
  EXPECT_EQ(scene.body.raw.posture.position_m[kHand], said) << "raw is what was inferred";
}

// The stump of an arm whose hand is outside of the sensor's range was classified as the hand.
TEST(HiddenJoints, AreNotTrackedInFreeSpace) {
  HandInTheAir scene(recon::TrackingState::kTracked);
  scene.Hand(1);
  EXPECT_EQ(scene.body.joints[kHand].state, recon::TrackingState::kInferred);
  EXPECT_EQ(scene.body.joints[kWrist].state, recon::TrackingState::kTracked);
  EXPECT_EQ(scene.body.raw.state[kHand], recon::TrackingState::kTracked) << "raw stays raw";
}

// Strong smoothing lags behind a fast hand, which is seen nevertheless.
TEST(HiddenJoints, VisibleJointsStayTrackedWhileSmoothingLags) {
  HandInTheAir scene(recon::TrackingState::kTracked);
  scene.options.smoothing = SmoothingPreset("verysmooth");
  scene.Hand(10);
  scene.body.raw.posture = scene.render.joints.front();
  scene.Step(10 / 30.0);
  ASSERT_TRUE(recon::IsInFreeSpace(scene.body.joints[kHand].position_m, scene.render.frame));
  EXPECT_EQ(scene.body.joints[kHand].state, recon::TrackingState::kTracked);
}

TEST(HiddenJoints, ReappearingJointsStayAtTheirObservation) {
  HandInTheAir scene(recon::TrackingState::kInferred);
  scene.Hand(10);
  scene.body.raw.state[kHand] = recon::TrackingState::kTracked;
  EXPECT_LT((scene.Hand(1) - scene.body.raw.posture.position_m[kHand]).norm(), 0.061);
}

// A forearm whose estimate changes suddenly: the displacement of its wrist in a frame.
double WristGoes_m(recon::TrackingState state, const HoldOptions& hold = {}) {
  HandInTheAir scene(recon::TrackingState::kTracked);
  scene.options.reconstructor.method = "best";
  scene.options.hold = hold;
  scene.body.raw.posture = scene.render.joints.front();
  scene.Step(0.0);
  const Eigen::Vector3d before = scene.body.joints[kWrist].position_m;
  for (const size_t j : {kWrist, kHand}) {
    scene.body.raw.posture.position_m[j] += Eigen::Vector3d(0.0, 0.4, -0.2);
    scene.body.raw.state[j] = state;
  }
  scene.Step(1.0 / 30.0);
  return (scene.body.joints[kWrist].position_m - before).norm();
}

TEST(HiddenJoints, DoNotJump) {
  constexpr double kElbowMoves_m = 0.03, kLeap_m = 0.25;
  HoldOptions fast;
  fast.guess_m_s = 100.0;
  EXPECT_GT(WristGoes_m(recon::TrackingState::kInferred, fast), kLeap_m);
  EXPECT_LT(WristGoes_m(recon::TrackingState::kInferred),
            HoldOptions().guess_m_s / 30.0 + kElbowMoves_m);
  EXPECT_GT(WristGoes_m(recon::TrackingState::kTracked), kLeap_m)
      << "what is seen is there at once";
}

// A joint that the forest detects as a hand, and the refinement places farther back, aside or
// below.
recon::TrackingState StateOfHandSaid(const Eigen::Vector3d& off_m) {
  HandInTheAir scene(recon::TrackingState::kTracked);
  scene.options.reconstructor.method = "best";
  scene.body.raw.posture = scene.render.joints.front();
  scene.body.refined = scene.body.raw.posture;
  scene.body.refined->position_m[kHand] += off_m;
  scene.Step(0.0);
  EXPECT_EQ(scene.body.raw.state[kHand], recon::TrackingState::kTracked) << "raw stays raw";
  EXPECT_EQ(scene.body.joints[kWrist].state, recon::TrackingState::kTracked);
  return scene.body.joints[kHand].state;
}

TEST(HiddenJoints, IncludeObservationsOfOtherObjects) {
  const double far_m = HoldOptions().elsewhere_m + 0.1;
  EXPECT_EQ(StateOfHandSaid({0.0, 0.0, 0.1}), recon::TrackingState::kTracked);
  EXPECT_EQ(StateOfHandSaid({far_m, 0.0, 0.0}), recon::TrackingState::kInferred);
  EXPECT_EQ(StateOfHandSaid({0.0, -far_m, 0.0}), recon::TrackingState::kInferred);
}

// A desk's corner was classified as feet, which are below the image.
TEST(HiddenJoints, JointsOutsideTheImageAreNotTracked) {
  constexpr double kHighestFoot_m = -1.3;  // 2.5 m away the image ends above
  HandInTheAir scene(recon::TrackingState::kTracked);
  scene.body.raw.posture = scene.render.joints.front();
  constexpr auto kFoot = recon::Index(recon::Joint::kFootLeft);
  ASSERT_GT(scene.body.raw.posture.position_m[kFoot].y(), kHighestFoot_m);
  scene.Step(0.0);
  EXPECT_EQ(scene.body.joints[kFoot].state, recon::TrackingState::kTracked);
  scene.body.refined = scene.body.raw.posture;
  scene.body.refined->position_m[kFoot].y() = kHighestFoot_m;
  scene.options.reconstructor.method = "best";
  scene.Step(1.0 / 30.0);
  EXPECT_EQ(scene.body.joints[kFoot].state, recon::TrackingState::kInferred);
}

}  // namespace
}  // namespace ossa::tracker
