#include "depth/base/perceptron/pose_regression.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <vector>

#include "depth/base/perceptron/quantised_perceptron.h"
#include "tests/support/perceptrons.h"

namespace ossa {
namespace {

const Eigen::Vector3d kMiddle_m(0.4, -0.2, 2.5);

TEST(ViewFrame, HasItsDepthAlongTheRayAndIsLevel) {
  const auto frame = MakeViewFrame(kMiddle_m);
  ASSERT_TRUE(frame);
  const Eigen::Matrix3d& r = frame->frame_from_camera;
  EXPECT_TRUE((r * r.transpose()).isIdentity(1e-12));
  EXPECT_NEAR(r.determinant(), 1.0, 1e-12);
  EXPECT_NEAR((r * kMiddle_m - Eigen::Vector3d(0.0, 0.0, kMiddle_m.norm())).norm(), 0.0, 1e-12);
  EXPECT_NEAR(r(0, 1), 0.0, 1e-12);
}

TEST(ViewFrame, IsUndefinedBehindAboveAndBelowTheCamera) {
  EXPECT_FALSE(MakeViewFrame({0.0, 0.0, -2.0}));
  EXPECT_FALSE(MakeViewFrame({0.0, 2.0, 1e-9}));
  EXPECT_FALSE(MakeViewFrame({0.0, -2.0, 1e-9}));
}

TEST(ComputeMiddle, WeighsPointsWithAMinimumWeight) {
  const std::array<Eigen::Vector3d, 2> points_m = {Eigen::Vector3d(0.0, 0.0, 1.0),
                                                   Eigen::Vector3d(1.0, 0.0, 1.0)};
  const std::array<double, 2> weights = {0.95, 0.0};
  EXPECT_NEAR(ComputeMiddle(points_m, weights, 0.05).x(), 0.05, 1e-12);
}

// The network outputs the targets of EncodeOffset: then points are at their true positions.
template <typename Network>
void ExpectMovedTo(double tolerance_m) {
  const ViewFrame frame = *MakeViewFrame(kMiddle_m);
  std::vector<Eigen::Vector3d> points_m = {kMiddle_m, kMiddle_m + Eigen::Vector3d(0.2, 0.3, 0.1)};
  const std::vector<Eigen::Vector3d> wanted_m = {points_m[0] + Eigen::Vector3d(0.05, 0.0, -0.02),
                                                 points_m[1] + Eigen::Vector3d(0.0, 0.1, 0.0)};
  Perceptron perceptron = test::SilentPerceptron({4, 6});
  for (Eigen::Index k = 0; k < 2; ++k) {
    const auto p = static_cast<size_t>(k);
    perceptron.layers[0].bias.segment<3>(3 * k) =
        EncodeOffset(points_m[p], wanted_m[p], frame, OffsetScale());
  }
  const std::array<size_t, 2> both = {0, 1};
  const RegressedPoints rows{both};
  Regress(Network(perceptron), RowMatrix::Ones(1, 4), std::span(&rows, 1), frame, OffsetScale(),
          points_m);
  for (size_t p = 0; p < 2; ++p) EXPECT_LT((points_m[p] - wanted_m[p]).norm(), tolerance_m);
}

TEST(Regress, MovesPointsByTheNetworksOutputs) {
  ExpectMovedTo<Perceptron>(1e-7);
  ExpectMovedTo<QuantisedPerceptron>(1e-7);
}

TEST(Regress, ExchangesLeftAndRightOfTheMirrorImage) {
  const ViewFrame frame{Eigen::Matrix3d::Identity(), kMiddle_m};
  std::vector<Eigen::Vector3d> points_m(2, kMiddle_m);
  const std::array<size_t, 2> of = {0, 1};
  const std::array<RegressedPoints, 2> rows = {RegressedPoints{std::span(&of[0], 1), false},
                                               RegressedPoints{std::span(&of[1], 1), true}};
  RowMatrix outputs(2, 3);
  outputs << 1.0F, 2.0F, 3.0F, 1.0F, 2.0F, 3.0F;
  MovePoints(outputs, rows, frame, OffsetScale(), points_m);
  EXPECT_TRUE((points_m[0] - kMiddle_m).isApprox(Eigen::Vector3d(0.1, 0.2, 0.3), 1e-7));
  EXPECT_TRUE((points_m[1] - kMiddle_m).isApprox(Eigen::Vector3d(-0.1, 0.2, 0.3), 1e-7));
}

TEST(Regress, MovesNoPointFartherThanAllowed) {
  const ViewFrame frame{Eigen::Matrix3d::Identity(), kMiddle_m};
  std::vector<Eigen::Vector3d> points_m = {kMiddle_m};
  const size_t first = 0;
  const RegressedPoints row{std::span(&first, 1)};
  RowMatrix outputs(1, 3);
  outputs << 30.0F, 0.0F, 40.0F;
  MovePoints(outputs, std::span(&row, 1), frame, {.step_m = 0.1, .farthest_m = 0.5}, points_m);
  EXPECT_TRUE((points_m[0] - kMiddle_m).isApprox(Eigen::Vector3d(0.3, 0.0, 0.4), 1e-7));
}

}  // namespace
}  // namespace ossa
