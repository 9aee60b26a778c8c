#include "recon/refine/bone_estimation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "recon/normalise.h"
#include "tests/recon/refine/refinement_scene.h"

namespace ossa::recon {
namespace {

using test::NetworkOf;
using test::Scene;
using test::Silent;
using test::SilentAndBoneConditioned;
using test::StandardBones;

TEST(BoneEstimation, PredictsLogarithmsOfRatiosToTheStandardBones) {
  Scene scene;
  scene.input.proposed[Joint::kFootRight] = scene.input.proposed[Joint::kAnkleRight];  // no length
  const auto person = ProposedPerson::Locate(scene.input);
  ASSERT_TRUE(person);
  EXPECT_TRUE(ComputeBoneFeatures(*person).allFinite());
  BoneLengths lengths_m = StandardBoneLengths();
  EXPECT_LT(EncodeBoneLengths(lengths_m).norm(), 1e-6F);
  const auto shin = Index(Joint::kAnkleLeft);
  lengths_m[shin] *= 1.2;  // of the left one only: half of it for the pair
  const Eigen::RowVectorXf outputs = EncodeBoneLengths(lengths_m);
  EXPECT_NEAR(outputs.cwiseAbs().maxCoeff(), std::log(1.1) / kBoneStep, 1e-4);
  EXPECT_NEAR(outputs.cwiseAbs().sum(), std::log(1.1) / kBoneStep, 1e-4);
}

// A network that adds up where the left hand and the right one are, sideways: nothing in the mean
// of a person and the mirror image, but for what the bias says.
TEST(BoneEstimation, IsTheMeanOfThePersonAndTheMirrorImage) {
  Scene scene;
  scene.input.proposed[Joint::kHandLeft].x() += 0.4;
  RefinementCascade cascade = Silent();
  EXPECT_FALSE(JointRefiner(cascade).Refine(scene.input)->bones_m);
  cascade.bones = StandardBones();
  cascade.bones.layers[0].bias[0] = 1.0F;
  cascade.bones.layers[0].bias[1] = 1000.0F;
  for (const Joint hand : {Joint::kHandLeft, Joint::kHandRight}) {
    cascade.bones.layers[0].weight.row(FirstCoordinate(Index(hand))).setConstant(1.0F);
  }
  const auto refined = JointRefiner(cascade).Refine(scene.input);
  ASSERT_TRUE(refined && refined->bones_m);
  const auto over = [&](Joint joint) {
    const auto j = Index(joint);
    return (*refined->bones_m)[j] / StandardBoneLengths()[j];
  };
  EXPECT_NEAR(over(Joint::kSpine), std::exp(kBoneStep), 1e-4);
  EXPECT_NEAR(over(Joint::kShoulderCenter), std::exp(1.0), 1e-4);  // no giants
  EXPECT_NEAR(over(Joint::kKneeLeft), 1.0, 1e-4);
  EXPECT_EQ(over(Joint::kKneeLeft), over(Joint::kKneeRight));
}

// The head rises by a step for each step of the first bone, the spine; every stage before, and
// what is said of the bones, is of joints where the others put them.
TEST(RefinementCascade, LaterStagesReadTheBoneLengths) {
  Scene scene;
  RefinementCascade cascade = SilentAndBoneConditioned();
  cascade.bone_conditioned[0][NetworkOf(Joint::kHead)].layers[0].weight(kStageFeatures, 1) = 1.0F;
  const auto rise_m = [&](const std::optional<BoneLengths>& bones_m) {
    scene.input.bones_m = bones_m;
    const auto refined = JointRefiner(cascade).Refine(scene.input);
    EXPECT_TRUE(refined && refined->bones_m);
    EXPECT_NEAR((*refined->bones_m)[Joint::kFootLeft], StandardBoneLengths()[Joint::kFootLeft],
                1e-6);
    return (refined->joints_m[Joint::kHead] - scene.input.proposed[Joint::kHead]).norm();
  };
  BoneLengths tall_m = StandardBoneLengths();
  tall_m[Joint::kSpine] *= std::exp(2.0 * kBoneStep);
  EXPECT_NEAR(rise_m(tall_m), 2.0 * RefinementCascade::kOffsets.step_m, 1e-4);
  EXPECT_NEAR(rise_m(std::nullopt), 0.0, 1e-6);  // what is judged of this frame
  cascade.bones.layers[0].bias[0] = 1.0F;
  EXPECT_NEAR(rise_m(std::nullopt), RefinementCascade::kOffsets.step_m, 1e-4);
  for (const double odd_m : {0.0, -1.0, std::nan(""), 1e300}) {
    tall_m[Joint::kHandRight] = odd_m;
    EXPECT_NEAR(rise_m(tall_m), RefinementCascade::kOffsets.step_m, 1e-4) << odd_m;
  }
}

}  // namespace
}  // namespace ossa::recon
