#include "tools/synth/interaction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "recon/body/standard_body.h"

namespace ossa::tools {
namespace {

using recon::Joint;

struct Staged {
  Interaction interaction = Interaction::kNone;
  recon::Posture joints;
  std::vector<Prop> props;
};

/// Somebody upright with things; the world is the camera's space, y up, facing +z.
Staged Stage(Interaction interaction, uint64_t seed) {
  Random random(seed, 1);
  recon::RigPose pose;
  pose.root_m = recon::StandardRigRest().head_m[0];
  Staged staged;
  staged.interaction = ArrangeArms(interaction, &pose, random);
  staged.joints = recon::StandardPosture(pose);
  staged.props =
      InteractionProps(staged.interaction, staged.joints, Eigen::Isometry3d::Identity(), random);
  return staged;
}

TEST(Interaction, HeldUpObjectIsBetweenTheHandsInFrontOfTheChest) {
  int between = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Staged staged = Stage(Interaction::kHeldUp, seed);
    ASSERT_EQ(staged.interaction, Interaction::kHeldUp);
    const auto& joints = staged.joints;
    EXPECT_GT(joints[Joint::kHandLeft].z(), joints[Joint::kShoulderCenter].z() + 0.1);
    EXPECT_GT(joints[Joint::kHandLeft].x(), joints[Joint::kHandRight].x());
    ASSERT_EQ(staged.props.size(), 1u);
    Eigen::AlignedBox3f box;
    for (const auto& p : staged.props[0].mesh_in_cam.vertices_m) box.extend(p);
    const Eigen::Vector3f middle_m =
        (joints[Joint::kHandLeft] + joints[Joint::kHandRight]).cast<float>() / 2;
    between += box.exteriorDistance(middle_m) < 0.12F ? 1 : 0;
    EXPECT_EQ(staged.props[0].part, recon::kOtherPart);
  }
  EXPECT_GE(between, 18);
}

TEST(Interaction, ForearmsLieOnTheDesk) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const Staged staged = Stage(Interaction::kAtDesk, seed);
    ASSERT_EQ(staged.interaction, Interaction::kAtDesk);
    float top_m = 0;  // of the table; what lies on it comes after
    for (const auto& p : staged.props[0].mesh_in_cam.vertices_m) top_m = std::max(top_m, p.y());
    for (const Joint joint :
         {Joint::kElbowLeft, Joint::kHandLeft, Joint::kElbowRight, Joint::kHandRight}) {
      const double above_m = staged.joints[joint].y() - top_m;
      EXPECT_GT(above_m, 0.02) << "through the desk, seed " << seed;
      EXPECT_LT(above_m, 0.2) << "in the air, seed " << seed;
    }
  }
}

TEST(Interaction, LyingPersonHoldsNothingUp) {
  Random random(1, 1);
  recon::RigPose pose;
  const Eigen::Quaterniond back(Eigen::AngleAxisd(-1.57, Eigen::Vector3d::UnitX()));
  for (auto& q : pose.world_from_rest) q = back;
  const recon::RigPose before = pose;
  EXPECT_EQ(ArrangeArms(Interaction::kHeldUp, &pose, random), Interaction::kNone);
  EXPECT_TRUE(pose.world_from_rest[20].isApprox(before.world_from_rest[20]));
}

TEST(Interaction, IsRequestedByNameAndDoesNotChangeOtherOccluders) {
  Random random(1, 1);
  EXPECT_EQ(DrawInteraction(*OccludersFromName("held-up"), random), Interaction::kHeldUp);
  for (const char* name : {"none", "held", "scene", "any"}) {
    EXPECT_EQ(DrawInteraction(*OccludersFromName(name), random), Interaction::kNone) << name;
  }
  std::set<Interaction> drawn;
  for (int i = 0; i < 400; ++i) drawn.insert(DrawInteraction(*OccludersFromName("all"), random));
  EXPECT_EQ(drawn.size(), 6u);
}

}  // namespace
}  // namespace ossa::tools
