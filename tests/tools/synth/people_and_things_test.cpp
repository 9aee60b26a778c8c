// Accessories, distractors, wheelchairs and crutches, random postures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "recon/body/clothing.h"
#include "recon/body/standard_body.h"
#include "tools/synth/accessories.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/distractors.h"
#include "tools/synth/interaction.h"
#include "tools/synth/mobility_aids.h"
#include "tools/synth/random_posture.h"

namespace ossa::tools {
namespace {

using recon::Joint;

TEST(Accessories, HatHasTheUpperHeadsLabelsAndABagIsAnObject) {
  recon::RigPose pose;
  pose.root_m = recon::StandardRigRest().head_m[0];
  const recon::Posture joints = recon::StandardPosture(pose);
  Accessories accessories;
  accessories.hat = Accessories::Hat::kBrimmed;
  accessories.bag = Accessories::Bag::kRucksack;
  const auto props =
      AccessoryProps(accessories, pose, joints, 1.66, Eigen::Isometry3d::Identity(), 2);
  ASSERT_EQ(props.size(), 3u);
  const double middle_m = joints[Joint::kHead].x();
  for (const auto& p : props[0].mesh_in_cam.vertices_m) EXPECT_GE(p.x(), middle_m - 1e-5);
  for (const auto& p : props[1].mesh_in_cam.vertices_m) EXPECT_LE(p.x(), middle_m + 1e-5);
  EXPECT_EQ(props[0].part, 1);
  EXPECT_EQ(props[1].part, 2);
  EXPECT_EQ(props[2].part, recon::kOtherPart);
  for (const Prop& prop : props) EXPECT_EQ(prop.user, 2);
  // A rucksack is on the back.
  float farthest_back_m = 0;
  for (const auto& p : props[2].mesh_in_cam.vertices_m) {
    farthest_back_m = std::min(farthest_back_m, p.z());
  }
  EXPECT_LT(farthest_back_m, joints[Joint::kSpine].z() - 0.2);
}

TEST(Distractors, AreBackgroundAndLeaveThePersonsPlaceFree) {
  for (uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed, 1);
    const auto props = SampleDistractors(Eigen::Isometry3d::Identity(), random);
    EXPECT_GE(props.size(), 2u);
    for (const Prop& prop : props) {
      EXPECT_FALSE(prop.counts_as_other);
      float highest_m = 0;
      for (const auto& p : prop.mesh_in_cam.vertices_m) {
        highest_m = std::max(highest_m, p.y());
        EXPECT_GT(std::hypot(p.x(), p.z()), 0.05F);
      }
      EXPECT_GT(highest_m, 0.3F) << "as large as a part of a person";
      EXPECT_LT(highest_m, 3.0F);
    }
  }
}

TEST(RandomPosture, KeepsJointLimitsAndTouchesTheFloor) {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    Random random(seed, 1);
    const recon::Posture p = recon::StandardPosture(RandomPosture(random));
    const auto bend = [&](Joint a, Joint b, Joint c) {
      const Eigen::Vector3d u = (p[b] - p[a]).normalized(), v = (p[c] - p[b]).normalized();
      return std::acos(std::clamp(u.dot(v), -1.0, 1.0)) * 180 / 3.14159265;
    };
    EXPECT_LT(bend(Joint::kHipLeft, Joint::kKneeLeft, Joint::kAnkleLeft), 145);
    EXPECT_LT(bend(Joint::kShoulderRight, Joint::kElbowRight, Joint::kWristRight), 155);
    double lowest_m = 1e9;
    for (const auto& joint_m : p.position_m) lowest_m = std::min(lowest_m, joint_m.y());
    EXPECT_NEAR(lowest_m, 0.06, 1e-9);
  }
}

TEST(RandomPosture, StandsBendsAndLies) {
  int upright = 0, lying = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed, 1);
    const recon::Posture p = recon::StandardPosture(RandomPosture(random));
    const double up = (p[Joint::kShoulderCenter] - p[Joint::kHipCenter]).normalized().y();
    upright += up > 0.7 ? 1 : 0;
    lying += std::abs(up) < 0.4 ? 1 : 0;
  }
  EXPECT_GT(upright, 120);
  EXPECT_GT(lying, 80);
}

// Somebody who stands, arms down.
recon::RigPose Standing() {
  recon::RigPose pose;
  pose.root_m = recon::StandardRigRest().head_m[0];
  return pose;
}

TEST(Wheelchair, SeatsThePersonAboveSeatWheelsAndFootplates) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed, 1);
    recon::RigPose pose = Standing();
    ASSERT_EQ(ArrangeArms(Interaction::kWheelchair, &pose, random), Interaction::kWheelchair);
    const recon::Posture joints = recon::StandardPosture(pose);
    EXPECT_LT(std::abs(joints[Joint::kKneeLeft].y() - joints[Joint::kHipLeft].y()), 0.12);
    EXPECT_GT(joints[Joint::kKneeLeft].z() - joints[Joint::kHipLeft].z(), 0.3);
    EXPECT_NEAR(std::min(joints[Joint::kAnkleLeft].y(), joints[Joint::kAnkleRight].y()), 0.08,
                1e-9);
    const auto props =
        InteractionProps(Interaction::kWheelchair, joints, Eigen::Isometry3d::Identity(), random);
    ASSERT_EQ(props.size(), 1U);
    EXPECT_EQ(props[0].part, recon::kOtherPart);
    EXPECT_TRUE(props[0].counts_as_other);
    Eigen::AlignedBox3f box;
    bool seat = false;
    const Eigen::Vector3f hips_m = joints[Joint::kHipCenter].cast<float>();
    for (const auto& p : props[0].mesh_in_cam.vertices_m) {
      box.extend(p);
      seat = seat || (std::abs(p.y() - (hips_m.y() - 0.1F)) < 0.03F && p.z() > hips_m.z() + 0.1F);
    }
    EXPECT_TRUE(seat) << "something to sit on under the thighs";
    EXPECT_NEAR(box.min().y(), 0.0F, 0.03F) << "it stands on the floor";
    EXPECT_GT(box.max().y(), 0.85F) << "with handles";
    EXPECT_LT(box.min().x(), hips_m.x() - 0.24F) << "a wheel on either side";
    EXPECT_GT(box.max().x(), hips_m.x() + 0.24F);
    EXPECT_LT((box.max() - box.min()).maxCoeff(), 1.6F);
  }
}

TEST(Crutches, ReachFromTheFloorToTheHands) {
  int two = 0;
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed, 1);
    recon::RigPose pose = Standing();
    ASSERT_EQ(ArrangeArms(Interaction::kCrutches, &pose, random), Interaction::kCrutches);
    const recon::Posture joints = recon::StandardPosture(pose);
    const auto props =
        InteractionProps(Interaction::kCrutches, joints, Eigen::Isometry3d::Identity(), random);
    ASSERT_FALSE(props.empty());
    two += props.size() == 2 ? 1 : 0;
    for (const Prop& prop : props) {
      EXPECT_EQ(prop.part, recon::kOtherPart);
      const Joint hand = prop.grip == Grip::kLeftHand ? Joint::kHandLeft : Joint::kHandRight;
      float nearest_m = 1e9F, lowest_m = 1e9F;
      for (const auto& p : prop.mesh_in_cam.vertices_m) {
        nearest_m = std::min(nearest_m, (p - joints[hand].cast<float>()).norm());
        lowest_m = std::min(lowest_m, p.y());
      }
      EXPECT_LT(nearest_m, 0.08F);
      EXPECT_NEAR(lowest_m, 0.0F, 0.03F);
    }
  }
  EXPECT_GT(two, 8);
}

TEST(Gloves, ThickenHandsAndWristsOnly) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const recon::BodyModel model = LoadFetchedBody();
  const recon::Wardrobe wardrobe(model);
  const recon::ShapedBody body = model.Shape({});
  recon::Clothing bare, gloved;
  gloved.glove_m = 0.01;
  const auto without = wardrobe.Dress(body, bare), with = wardrobe.Dress(body, gloved);
  double moved_m = 0;
  int hands = 0;
  for (size_t i = 0; i < without.size(); ++i) {
    const uint8_t part = model.vertex_part()[i];
    const bool arm = part >= 14 && part <= 17;  // wrists and hands
    ASSERT_TRUE(arm || with[i] == without[i]) << int{part};
    if (part != 16 && part != 17) continue;
    moved_m += (with[i] - without[i]).norm();
    ++hands;
  }
  ASSERT_GT(hands, 100);
  EXPECT_NEAR(moved_m / hands, 0.01, 0.003);
}

TEST(HangingClothes, WidenTheWaistOnly) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const recon::BodyModel model = LoadFetchedBody();
  const recon::Wardrobe wardrobe(model);
  const recon::ShapedBody body = model.Shape({});
  recon::Clothing fitting, hanging;
  hanging.hang = 1.0;
  const auto close = wardrobe.Dress(body, fitting), loose = wardrobe.Dress(body, hanging);
  double out_m = 0;
  int waist = 0;
  for (size_t i = 0; i < close.size(); ++i) {
    const uint8_t part = model.vertex_part()[i];
    const bool torso = part >= 18 && part <= 21;
    const double off_m =
        std::hypot(loose[i].x(), loose[i].z()) - std::hypot(close[i].x(), close[i].z());
    ASSERT_GE(off_m, -1e-5) << "cloth goes into nobody";
    ASSERT_TRUE(torso || loose[i] == close[i]);
    if (!torso || loose[i].y() < 0.95 || loose[i].y() > 1.1) continue;
    out_m += off_m;
    ++waist;
  }
  ASSERT_GT(waist, 100);
  EXPECT_GT(out_m / waist, 0.005) << "a waist is narrower than chest and back";
}

}  // namespace
}  // namespace ossa::tools
