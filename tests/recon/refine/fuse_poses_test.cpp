#include "recon/refine/fuse_poses.h"

#include <gtest/gtest.h>

namespace ossa::recon {
namespace {

TEST(FusePoses, WeighsByInverseVariance) {
  const FusionOptions options{
      .sure_m = 0.02, .unsure_m = 0.1, .unseen_ratio = 0.0, .off_on_real_depth = 2.0};
  Posture joints_m;
  for (Eigen::Vector3d& joint_m : joints_m.position_m) joint_m = {0.0, 0.0, 2.0};
  JointArray<double> confidence{};
  NetworkPose network;
  for (size_t j = 0; j < kJointCount; ++j) {
    network.joints_m.position_m[j] = {0.1, 0.0, 2.0};
    network.error_m[j] = 0.02;
  }
  confidence[Index(Joint::kHead)] = 1.0;      // 2 cm against 4
  confidence[Index(Joint::kKneeLeft)] = 0.5;  // 6 against 4
  network.error_m[Index(Joint::kHandLeft)] = 1e6;
  const Posture fused_m = FusePoses(joints_m, confidence, network, options);
  EXPECT_NEAR(fused_m[Joint::kHead].x(), 0.1 * 4.0 / 20.0, 1e-9);
  EXPECT_NEAR(fused_m[Joint::kKneeLeft].x(), 0.1 * 36.0 / 52.0, 1e-9);
  EXPECT_NEAR(fused_m[Joint::kSpine].x(), 0.1 * 100.0 / 116.0, 1e-9);
  EXPECT_NEAR(fused_m[Joint::kHandLeft].x(), 0.0, 1e-9);
}

// What hides a foot from the network hides it from the cascade, too.
TEST(FusePoses, ExpectsLargeErrorsOfUnseenJointsWhereTheNetworkDoes) {
  const FusionOptions options{.sure_m = 0.02,
                              .unsure_m = 0.1,
                              .unseen_ratio = 2.0,
                              .off_on_real_depth = 1.0,
                              .contradiction = 10.0};
  const Posture joints_m;
  JointArray<double> confidence{};
  confidence[Index(Joint::kHead)] = 1.0;
  NetworkPose network;
  for (Eigen::Vector3d& joint_m : network.joints_m.position_m) joint_m = {0.0, -0.1, 0.0};
  network.error_m.fill(0.02);
  network.error_m[Index(Joint::kFootLeft)] = 0.4;
  const Posture fused_m = FusePoses(joints_m, confidence, network, options);
  EXPECT_NEAR(fused_m[Joint::kHead].y(), -0.1 * 4.0 / 8.0, 1e-9);       // 2 cm against 2
  EXPECT_NEAR(fused_m[Joint::kSpine].y(), -0.1 * 100.0 / 104.0, 1e-9);  // 10 against 2
  EXPECT_NEAR(fused_m[Joint::kFootLeft].y(), -0.1 * 4.0 / 5.0, 1e-9);   // 80 against 40
}

// One estimate has a foot on the desk, the other below the image: their mean is wrong.
TEST(FusePoses, UsesTheMoreCertainOfContradictingPositions) {
  const FusionOptions options{
      .sure_m = 0.02, .unsure_m = 0.1, .off_on_real_depth = 1.0, .contradiction = 2.0};
  Posture joints_m;
  for (Eigen::Vector3d& joint_m : joints_m.position_m) joint_m = {0.0, 0.0, 2.0};
  JointArray<double> confidence{};
  NetworkPose network;
  for (size_t j = 0; j < kJointCount; ++j) network.joints_m.position_m[j] = {0.0, -0.9, 2.0};
  network.error_m.fill(0.05);
  confidence[Index(Joint::kFootRight)] = 1.0;
  const Posture fused_m = FusePoses(joints_m, confidence, network, options);
  EXPECT_EQ(fused_m[Joint::kFootRight].y(), 0.0);
  EXPECT_EQ(fused_m[Joint::kFootLeft].y(), -0.9);
}

}  // namespace
}  // namespace ossa::recon
