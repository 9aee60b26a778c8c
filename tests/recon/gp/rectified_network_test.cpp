#include "recon/gp/rectified_network.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "recon/gp/network_runner.h"
#include "tests/recon/gp/random_network.h"

namespace ossa::recon {
namespace {

using test::RandomNetwork;

TEST(NetworkRunner, SaysWhatTheNetworkSays) {
  std::srand(7);  // Eigen draws from it
  for (const int hidden : {0, 1, 2}) {
    const RectifiedNetwork network = RandomNetwork(hidden, hidden == 1 ? 7 : 103, 11);
    Eigen::MatrixXf some = 4.0F * Eigen::MatrixXf::Random(11, 3);
    some.col(0).head(6).setZero();
    some.col(1).setZero();
    const Eigen::MatrixXf said = NetworkRunner(network).Run(some);
    ASSERT_EQ(said.cols(), 3);
    for (Eigen::Index c = 0; c < 3; ++c) {
      EXPECT_LT((said.col(c) - network.Run(some.col(c))).norm(), 1e-3F) << hidden;
    }
  }
}

// 103 and 130 units: more than a line of the cache holds, and than two.
TEST(NetworkRunner, NetworksWhoseWeightsLieTogetherSayWhatEachSaysAlone) {
  std::srand(8);
  const std::vector<RectifiedNetwork> networks = {RandomNetwork(2, 103, 40), RandomNetwork(0, 1, 5),
                                                  RandomNetwork(1, 130, 40)};
  const auto runners = NetworkRunner::Of({&networks[0], &networks[1], &networks[2]});
  ASSERT_EQ(runners.size(), networks.size());
  for (size_t n = 0; n < networks.size(); ++n) {
    const Eigen::VectorXf some = Eigen::VectorXf::Random(networks[n].input_mean.size());
    const Eigen::VectorXf said = runners[n].Run(some);
    EXPECT_LT((said - networks[n].Run(some)).norm(), 1e-3F) << n;
    EXPECT_EQ(said, NetworkRunner(networks[n]).Run(some).col(0)) << n;
  }
}

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
