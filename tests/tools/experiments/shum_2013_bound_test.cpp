#include "tools/experiments/papers/shum_2013_bound.h"

#include <gtest/gtest.h>

#include <numbers>

#include "recon/database/posture_database.h"
#include "recon/normalise.h"

namespace ossa::tools {
namespace {

using recon::Joint;
using recon::Posture;

/// The stance with the left forearm and hand turned to point up.
Posture Raised() {
  Posture p = recon::StandardStance();
  const double fore_m = (p[Joint::kWristLeft] - p[Joint::kElbowLeft]).norm();
  const double hand_m = (p[Joint::kHandLeft] - p[Joint::kWristLeft]).norm();
  p[Joint::kWristLeft] = p[Joint::kElbowLeft] + fore_m * Eigen::Vector3d::UnitY();
  p[Joint::kHandLeft] = p[Joint::kWristLeft] + hand_m * Eigen::Vector3d::UnitY();
  return p;
}

recon::SkeletonSequence Performance(const Posture& normalised, double scale) {
  const Posture p =
      recon::Placed(recon::Scaled(normalised, scale), {{0.3, 0.1, 2.5}, std::numbers::pi});
  recon::SkeletonFrame frame;
  recon::BodyRecord& body = frame.bodies.emplace_back();
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    body.joints[j].emplace().position_m = p.position_m[j];
  }
  return {"one", {frame}};
}

recon::PostureDatabase Both() {
  recon::DatabaseOptions options;
  options.threshold_m = 0.05;
  return recon::PostureDatabase::Build({{"both", {recon::StandardStance(), Raised()}, {}}},
                                       options);
}

TEST(ComputeBound, IsZeroForADatabasePostureOfAnyBodySize) {
  ASSERT_EQ(Both().size(), 2);
  const auto bound = ComputeBound(Both(), Performance(Raised(), 1.2), {Joint::kHandLeft});
  ASSERT_TRUE(bound);
  EXPECT_NEAR(bound->nearest_cm, 0.0, 1e-3);
  EXPECT_NEAR(bound->by_parts_cm, 0.0, 1e-3);
}

TEST(ComputeBound, IsLargerWhereTheGivenPartsAreAmbiguous) {
  // The right hand is the same in both postures: the first of the two is taken.
  const auto bound = ComputeBound(Both(), Performance(Raised(), 1.0), {Joint::kHandRight});
  ASSERT_TRUE(bound);
  EXPECT_NEAR(bound->nearest_cm, 0.0, 1e-3);
  const Posture stance = recon::StandardStance(), raised = Raised();
  double wanted_cm = 0.0;  // eq. 18
  for (size_t i = 1; i < recon::kJointCount; ++i) {
    const auto parent = recon::ParentOf(i);
    wanted_cm += 100.0 / 19.0 *
                 ((stance.position_m[i] - stance.position_m[parent]) -
                  (raised.position_m[i] - raised.position_m[parent]))
                     .norm();
  }
  EXPECT_GT(wanted_cm, 1.0);
  EXPECT_NEAR(bound->by_parts_cm, wanted_cm, 1e-3);
  EXPECT_FALSE(ComputeBound(Both(), {"empty", {}}, {}));
}

TEST(ErrorByLimbs, IsOnlyAtTheWrongArm) {
  const auto truth = Performance(recon::StandardStance(), 1.0);
  const Eigen::Vector3d limbs_cm = ErrorByLimbs_cm(truth, Performance(Raised(), 1.0));
  EXPECT_NEAR(limbs_cm[0], 0.0, 1e-9);
  EXPECT_GT(limbs_cm[1], 1.0);
  EXPECT_NEAR(limbs_cm[2], 0.0, 1e-9);
}

}  // namespace
}  // namespace ossa::tools
