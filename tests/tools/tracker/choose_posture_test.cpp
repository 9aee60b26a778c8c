// The choice of modes for a posture, and its joint states.
#include "recon/body/standard_body.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/people/joint_targets.h"
#include "tools/tracker/choose_posture_internal.h"

namespace ossa::tracker {
namespace {

using forest::Proposal;
using recon::Index;
using recon::Joint;
using recon::TrackingState;

const depth::Camera kCamera = depth::KinectV1Camera(320, 240);

// A standing person 2.5 m away, with one confident proposal per joint.
class Choosing : public testing::Test {
 protected:
  void SetUp() override {
    OSSA_NEEDS_MODEL();
    model_ = ModelSet::Shipped("none").forest;
    targets_ = people::FindJointTargets(*model_, "body.ossa");
    recon::RigPose pose;
    standing_ = recon::StandardPosture(pose);
    for (Eigen::Vector3d& joint_m : standing_.position_m) joint_m.z() += 2.5;
    proposals_.resize(model_->targets().size());
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      ModesOf(static_cast<Joint>(j)) = {{standing_.position_m[j], 0.9, true}};
    }
    context_.camera = &kCamera;
    context_.expected_m = recon::MeasureBoneLengths(standing_);
  }
  std::vector<Proposal>& ModesOf(Joint joint) {
    return proposals_[static_cast<size_t>(targets_[Index(joint)])];
  }
  recon::TrackedPosture Choose() const {
    return ChoosePosture(*model_, targets_, proposals_, context_);
  }
  // A joint with one confident mode and another at `other_m`.
  void Rival(Joint joint, const Eigen::Vector3d& other_m, double confidence) {
    ModesOf(joint).insert(ModesOf(joint).begin(), {other_m, confidence, true});
  }

  std::shared_ptr<const forest::ForestModel> model_;
  people::JointTargets targets_{};
  recon::Posture standing_;
  std::vector<std::vector<Proposal>> proposals_;
  ChoiceContext context_;
};

TEST_F(Choosing, ConfidentVisibleModeIsTracked) {
  const recon::TrackedPosture chosen = Choose();
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    EXPECT_EQ(chosen.state[j], TrackingState::kTracked) << j;
    EXPECT_EQ(chosen.posture.position_m[j], standing_.position_m[j]) << j;
    EXPECT_EQ(chosen.confidence[j], 0.9) << j;
  }
}

TEST_F(Choosing, PrefersAModeWithPlausibleBonesOverAMoreLikelyOne) {
  const Eigen::Vector3d far_m = standing_[Joint::kElbowLeft] + Eigen::Vector3d(0.9, 0.0, 0.0);
  Rival(Joint::kElbowLeft, far_m, 0.95);
  EXPECT_EQ(Choose().posture[Joint::kElbowLeft], standing_[Joint::kElbowLeft]);
}

TEST_F(Choosing, PrefersTheLikelierPlausibleModeUnlessItJumps) {
  // Off across the bone, so that its length is the same.
  const Eigen::Vector3d beside_m = standing_[Joint::kHead] + Eigen::Vector3d(0.0, 0.0, -0.1);
  Rival(Joint::kHead, beside_m, 0.95);
  EXPECT_EQ(Choose().posture[Joint::kHead], beside_m);
  recon::TrackedPosture before;
  before.posture = standing_;
  before.state.fill(TrackingState::kTracked);
  context_.before = &before;
  EXPECT_EQ(Choose().posture[Joint::kHead], standing_[Joint::kHead]);
  before.state.fill(TrackingState::kInferred);  // inferred joints do not constrain
  EXPECT_EQ(Choose().posture[Joint::kHead], beside_m);
}

TEST_F(Choosing, UnlikelyModeIsNotChosen) {
  ModesOf(Joint::kHandRight)[0].confidence = 0.01;
  EXPECT_EQ(Choose().state[Index(Joint::kHandRight)], TrackingState::kNotTracked);
  ModesOf(Joint::kHandRight).clear();
  EXPECT_EQ(Choose().state[Index(Joint::kHandRight)], TrackingState::kNotTracked);
}

TEST_F(Choosing, ModeWithoutSurfaceOrOutsideTheImageIsInferred) {
  ModesOf(Joint::kKneeLeft)[0].seen = false;
  EXPECT_EQ(Choose().state[Index(Joint::kKneeLeft)], TrackingState::kInferred);
  for (Eigen::Vector3d& joint_m : standing_.position_m) joint_m.x() += 1.3;  // half in the image
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    ModesOf(static_cast<Joint>(j))[0].position_m = standing_.position_m[j];
  }
  const recon::TrackedPosture chosen = Choose();
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (j == Index(Joint::kKneeLeft)) continue;
    EXPECT_EQ(chosen.state[j], IsInImage(kCamera, standing_.position_m[j])
                                   ? TrackingState::kTracked
                                   : TrackingState::kInferred)
        << j;
  }
  EXPECT_EQ(chosen.state[Index(Joint::kHandLeft)], TrackingState::kInferred);
  EXPECT_EQ(chosen.state[Index(Joint::kHandRight)], TrackingState::kTracked);
}

TEST_F(Choosing, WeakerOfTwoCoincidentHandsIsInferred) {
  context_.options.worst_bone = 0.0;  // so that lengths do not matter
  ModesOf(Joint::kWristRight)[0].position_m = standing_[Joint::kWristLeft];
  ModesOf(Joint::kWristRight)[0].confidence = 0.8;
  recon::TrackedPosture chosen = Choose();
  EXPECT_EQ(chosen.state[Index(Joint::kWristLeft)], TrackingState::kTracked);
  EXPECT_EQ(chosen.state[Index(Joint::kWristRight)], TrackingState::kInferred);
  ModesOf(Joint::kWristRight)[0].position_m.y() += 2.0 * context_.options.one_place_m;
  chosen = Choose();
  EXPECT_EQ(chosen.state[Index(Joint::kWristRight)], TrackingState::kTracked);
}

TEST_F(Choosing, HipsAreInferredWithoutAVisibleThigh) {
  context_.leg_area_m2 = 0.5 * context_.options.thigh_m2;
  const recon::TrackedPosture chosen = Choose();
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool is_lower = j == Index(Joint::kHipCenter) || j >= Index(Joint::kHipLeft);
    EXPECT_EQ(chosen.state[j], is_lower ? TrackingState::kInferred : TrackingState::kTracked) << j;
  }
}

TEST(LearnBoneLengths, UsesBonesWithTrackedEnds) {
  recon::TrackedPosture observed;
  observed.posture = recon::StandardPosture(recon::RigPose{});
  for (Eigen::Vector3d& joint_m : observed.posture.position_m) joint_m *= 1.2;
  observed.state.fill(TrackingState::kTracked);
  observed.state[Index(Joint::kElbowLeft)] = TrackingState::kInferred;
  const recon::BoneLengths average_m = AverageBoneLengths();
  recon::BoneLengths lengths_m = average_m;
  LearnBoneLengths(observed, lengths_m);
  const double step = 0.2 / ChoiceOptions{}.learning_frames;
  EXPECT_NEAR(lengths_m[Joint::kKneeRight], (1.0 + step) * average_m[Joint::kKneeRight], 1e-9);
  for (const Joint joint : {Joint::kElbowLeft, Joint::kWristLeft}) {
    EXPECT_EQ(lengths_m[joint], average_m[joint]);
  }
  for (int frame = 0; frame < 1000; ++frame) LearnBoneLengths(observed, lengths_m);
  EXPECT_NEAR(lengths_m[Joint::kKneeRight], 1.2 * average_m[Joint::kKneeRight], 1e-6);
}

TEST(LearnBoneLengths, StayWithinHumanBounds) {
  recon::TrackedPosture observed;
  observed.posture = recon::StandardPosture(recon::RigPose{});
  for (Eigen::Vector3d& joint_m : observed.posture.position_m) joint_m *= 3.0;
  observed.state.fill(TrackingState::kTracked);
  const recon::BoneLengths average_m = AverageBoneLengths();
  recon::BoneLengths lengths_m = average_m;
  for (int frame = 0; frame < 1000; ++frame) LearnBoneLengths(observed, lengths_m);
  EXPECT_EQ(lengths_m[Joint::kKneeLeft], ChoiceOptions{}.longest * average_m[Joint::kKneeLeft]);
}

}  // namespace
}  // namespace ossa::tracker
