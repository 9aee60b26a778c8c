#include "recon/models/rectified_network.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace ossa::recon {
namespace {

TEST(WeightBytes, AreTheSameOfWeightsThatWereBytesOnce) {
  std::srand(3);
  Eigen::MatrixXf weight = Eigen::MatrixXf::Random(40, 30);
  weight.col(4) *= 1e-3F;
  weight.col(5).setZero();
  const WeightBytes once = BytesOf(weight), twice = BytesOf(once.Weights());
  EXPECT_EQ(once.of, twice.of);
  EXPECT_EQ(once.step, twice.step);
  EXPECT_EQ(once.of.col(4).cwiseAbs().maxCoeff(), 127);
  for (Eigen::Index i = 0; i < weight.cols(); ++i) {
    const float error = (once.Weights().col(i) - weight.col(i)).cwiseAbs().maxCoeff();
    EXPECT_LE(error, 0.51F * once.step[i]) << i;
  }
}

TEST(RectifiedNetwork, RectifiesEveryLayerButTheLast) {
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Constant(1, 1.0F);
  network.input_scale = Eigen::VectorXf::Constant(1, 2.0F);
  Eigen::MatrixXf both(2, 1), sum(1, 2), minus(1, 1);
  both << 1.0F, -1.0F;
  sum << 1.0F, -3.0F;
  minus << -1.0F;
  network.layers = {{both, Eigen::VectorXf::Zero(2)},
                    {sum, Eigen::VectorXf::Constant(1, 0.5F)},
                    {minus, Eigen::VectorXf::Zero(1)}};
  const auto said = [&](float x) { return network.Run(Eigen::VectorXf::Constant(1, x))[0]; };
  EXPECT_FLOAT_EQ(said(2.0F), -2.5F);  // 2 -> (2, 0) -> 2.5 -> -2.5
  EXPECT_FLOAT_EQ(said(0.0F), 0.0F);   // -2 -> (0, 2) -> rectified
  EXPECT_FLOAT_EQ(said(1e6F), -5.5F);  // no more than five standard deviations are believed
}

}  // namespace
}  // namespace ossa::recon
