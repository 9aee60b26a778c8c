#include "recon/models/network_runner.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <random>
#include <vector>

#include "recon/models/weight_sums_internal.h"
#include "tests/recon/models/random_network.h"

namespace ossa::recon {
namespace {

using test::RandomNetwork;

// But for the rounding of what weights are taken times: to one in 2^15 of the largest, or nearly
// so.
void ExpectAboutEqual(const Eigen::VectorXf& said, const Eigen::VectorXf& wanted) {
  EXPECT_LT((said - wanted).norm(), 1e-4F * (1.0F + wanted.norm()));
}

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
      ExpectAboutEqual(said.col(c), network.Run(some.col(c)));
    }
  }
}

// 103 and 130 units: more than three lines of the cache hold, and than four.
TEST(NetworkRunner, NetworksWhoseWeightsLieTogetherSayWhatEachSaysAlone) {
  std::srand(8);
  const std::vector<RectifiedNetwork> networks = {RandomNetwork(2, 103, 40), RandomNetwork(0, 1, 5),
                                                  RandomNetwork(1, 130, 40)};
  const auto runners = NetworkRunner::Of({&networks[0], &networks[1], &networks[2]});
  ASSERT_EQ(runners.size(), networks.size());
  for (size_t n = 0; n < networks.size(); ++n) {
    const Eigen::VectorXf some = Eigen::VectorXf::Random(networks[n].input_mean.size());
    const Eigen::VectorXf said = runners[n].Run(some);
    ExpectAboutEqual(said, networks[n].Run(some));
    EXPECT_EQ(said, NetworkRunner(networks[n]).Run(some).col(0)) << n;
  }
}

// Twice as many inputs as may say their most, all of one sign: the sum would turn negative.
TEST(NetworkRunner, ManyLoudInputsAddUp) {
  constexpr Eigen::Index kInputs = 1100;
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Zero(kInputs);
  network.input_scale = Eigen::VectorXf::Ones(kInputs);
  network.layers = {
      {BytesOf(Eigen::MatrixXf::Ones(1, kInputs)).Weights(), Eigen::VectorXf::Zero(1)}};
  for (const float each : {5.0F, -5.0F}) {
    const Eigen::VectorXf loud = Eigen::VectorXf::Constant(kInputs, each);
    ExpectAboutEqual(NetworkRunner(network).Run(loud), network.Run(loud));
  }
}

// An input that says a thousandth of what another does is still heard.
TEST(NetworkRunner, QuietInputsAreHeardBesideALoudOne) {
  RectifiedNetwork network;
  network.input_mean = Eigen::VectorXf::Zero(2);
  network.input_scale = Eigen::VectorXf::Ones(2);
  network.layers = {{BytesOf(Eigen::MatrixXf::Identity(2, 2)).Weights(), Eigen::VectorXf::Zero(2)}};
  const Eigen::Vector2f some(4.0F, 0.004F);
  const Eigen::VectorXf said = NetworkRunner(network).Run(some), wanted = network.Run(some);
  EXPECT_NEAR(said[0], wanted[0], 1e-4F);
  EXPECT_NEAR(said[1], wanted[1], 1e-4F);
  EXPECT_GT(wanted[1], 3e-3F);
}

template <size_t kColumns>
void ExpectTheSameSums() {
  std::mt19937 draw(5);
  std::uniform_int_distribution<int> weight(-127, 127), factor(-16000, 16000);
  constexpr size_t kPairs = 37, kBlocks = 3;
  std::vector<WeightLine> lines(kBlocks * kPairs);
  for (WeightLine& line : lines) {
    for (auto& [first, second] : line.weights) {
      first = static_cast<int8_t>(weight(draw));
      second = static_cast<int8_t>(weight(draw));
    }
  }
  std::vector<PairFactors<kColumns>> factors(kPairs);
  for (PairFactors<kColumns>& pair : factors) {
    for (auto& [first, second] : pair) {
      first = static_cast<int16_t>(factor(draw));
      second = static_cast<int16_t>(factor(draw));
    }
  }
  const auto sums_by = [&](auto add) {
    std::array<std::vector<int32_t>, kColumns> sums;
    WeightSums<kColumns> of{.factors = factors, .lines = lines.data(), .blocks = kBlocks};
    for (size_t c = 0; c < kColumns; ++c) {
      sums[c].assign(kBlocks * WeightLine::kUnits, -1);
      of.sums[c] = sums[c].data();
    }
    add(of);
    return sums;
  };
  const auto sums = sums_by([](const auto& of) { AddWeights(of); });
  EXPECT_EQ(sums, sums_by([](const auto& of) { AddWeightsOneByOne(of); }));
  constexpr size_t kUnit = WeightLine::kUnits + 9;  // in the second block
  int32_t wanted = 0;
  for (size_t pair = 0; pair < kPairs; ++pair) {
    for (size_t i = 0; i < 2; ++i) {
      wanted += lines[kPairs + pair].weights[9][i] * factors[pair].back()[i];
    }
  }
  EXPECT_EQ(sums.back()[kUnit], wanted);
}

TEST(WeightSums, AreTheSameOneByOne) {
  ExpectTheSameSums<1>();
  ExpectTheSameSums<2>();
}

}  // namespace
}  // namespace ossa::recon
