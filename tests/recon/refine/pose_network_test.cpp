#include "recon/refine/pose_network.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "depth/base/checksummed_container.h"
#include "tests/recon/refine/pose_networks.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using ossa::test::ExpectRefused;
using test::EmptyCrop;
using test::SilentLayers;

constexpr Eigen::Index kHead = 5 * static_cast<Eigen::Index>(Index(Joint::kHead));

TEST(PoseNetwork, CellsVoteForPositionsWithConfidence) {
  auto layers = SilentLayers();
  Eigen::RowVectorXf& votes = layers.back().bias;
  votes.segment<5>(kHead) << 0.0F, 0.5F, 1.0F, -0.5F, std::log(0.5F);
  const PoseNetwork network(layers, 1, "test");
  const NetworkPose pose = network.Run(EmptyCrop(2.0));
  // All cells alike: the middle, and the offset in steps of 20 cm; x and y at the middle's
  // distance.
  const double nearer = 1.9 / 2.0;
  const Eigen::Vector3d expected(0.1 * nearer, 0.2 * nearer, 1.9);
  EXPECT_LT((pose.joints_m[Joint::kHead] - expected).norm(), 1e-6);
  EXPECT_LT((pose.joints_m[Joint::kSpine] - Eigen::Vector3d(0, 0, 2)).norm(), 1e-6);
  // Three times the scale of a density that falls as exp(-distance / scale) in space.
  EXPECT_NEAR(pose.error_m[Index(Joint::kHead)], 3 * 0.05, 1e-6);
  EXPECT_NEAR(pose.error_m[Index(Joint::kSpine)], 3 * 0.1, 1e-6);
}

// Every layer passes on how much surface a cell holds: the head goes where the surface is.
TEST(PoseNetwork, JointIsAtTheCellsWithTheMostVotes) {
  auto layers = SilentLayers();
  const auto centre = [](const Convolution& layer) {
    return layer.size * layer.size / 2 * layer.inputs();
  };
  for (size_t l = 0; l < 3; ++l) {
    layers[l].weight(centre(layers[l]) + (l == 0 ? 1 : 0), 0) = 1.0F;
  }
  layers[11].weight(centre(layers[11]), 0) = 1.0F;
  layers[12].weight(0, kHead) = 50.0F;
  const PoseNetwork network(layers, 1, "test");
  PersonCrop crop = EmptyCrop(3.0);
  constexpr int kRow = 16, kColumn = 64;  // cells, multiples of 8: the votes' map is 12 by 12
  for (int row = kRow; row < kRow + 8; ++row) {
    for (int column = kColumn; column < kColumn + 8; ++column) {
      crop.cells[static_cast<size_t>(row * kCropSide + column)].surface = kCropTaps;
    }
  }
  const NetworkPose pose = network.Run(crop);
  const auto place_m = [](int begin) { return (47.5 - (begin + 3.5)) * kCropCell_m; };
  EXPECT_NEAR(pose.joints_m[Joint::kHead].x(), place_m(kColumn), 1e-3);
  EXPECT_NEAR(pose.joints_m[Joint::kHead].y(), place_m(kRow), 1e-3);
}

TEST(PoseNetwork, JointsAreFiniteAndInFrontOfTheCamera) {
  auto layers = SilentLayers();
  layers.back().bias[kHead + 3] = -100.0F;
  NetworkPose pose = PoseNetwork(layers, 1, "test").Run(EmptyCrop(2.0));
  EXPECT_GT(pose.joints_m[Joint::kHead].z(), 0.0);
  layers.back().bias[kHead] = 1e6F;
  layers.back().bias[kHead + 4] = 1e6F;
  pose = PoseNetwork(layers, 1, "test").Run(EmptyCrop(2.0));
  EXPECT_TRUE(pose.joints_m[Joint::kHead].allFinite());
  EXPECT_GT(pose.error_m[Index(Joint::kHead)], 100.0);
  EXPECT_LT(pose.error_m[Index(Joint::kHead)], 1e6);
}

TEST(PoseNetwork, SurvivesAFile) {
  const ossa::test::TemporaryFolder folder;
  auto layers = SilentLayers();
  for (Convolution& layer : layers) {
    layer.weight.setRandom();
    layer.bias.setRandom();
  }
  const PoseNetwork network(layers, 12, "test");
  network.Save(folder / "a.ossanet");
  EXPECT_TRUE(PoseNetwork::IsFile(folder / "a.ossanet"));
  const PoseNetwork read = PoseNetwork::Load(folder / "a.ossanet");
  EXPECT_EQ(read.people(), 12U);
  for (size_t l = 0; l < PoseNetwork::kLayers; ++l) {
    EXPECT_LT((read.layers()[l].weight - layers[l].weight).cwiseAbs().maxCoeff(), 1.0F / 256.0F);
    EXPECT_EQ(read.layers()[l].bias, layers[l].bias);
  }
  read.Save(folder / "b.ossanet");
  const auto bytes = [&](const char* name) {
    std::ifstream in(folder / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_EQ(bytes("a.ossanet"), bytes("b.ossanet"));
  std::ofstream(folder / "short.ossanet", std::ios::binary) << bytes("a.ossanet").substr(0, 100);
  ExpectRefused([&] { PoseNetwork::Load(folder / "short.ossanet"); }, "short.ossanet");
}

TEST(PoseNetwork, LayersThatDoNotFitTogetherAreRefusedByNumber) {
  auto layers = SilentLayers();
  layers[4].weight.conservativeResize(Eigen::NoChange, 3);
  ExpectRefused([&] { PoseNetwork(layers, 1, "x.ossanet"); }, "x.ossanet: layer 5");
  layers = SilentLayers();
  layers[3].stride = 2;
  ExpectRefused([&] { PoseNetwork(layers, 1, "x.ossanet"); }, "layer 4");
}

TEST(PoseNetwork, NanAndHugeWeightsAreRefused) {
  auto layers = SilentLayers();
  layers[2].weight(1, 1) = std::numeric_limits<float>::quiet_NaN();
  ExpectRefused([&] { PoseNetwork(layers, 1, "x.ossanet"); }, "layer 3: expected numbers");
  layers = SilentLayers();
  layers[7].bias[0] = -2e6F;
  ExpectRefused([&] { PoseNetwork(layers, 1, "x.ossanet"); }, "layer 8: expected numbers");
}

// One field of the payload spoilt at a time.
TEST(PoseNetwork, InvalidFieldIsRefusedByName) {
  const ossa::test::TemporaryFolder folder;
  PoseNetwork(SilentLayers(), 1, "test").Save(folder / "a.ossanet");
  const ContainerFormat format = {
      {'O', 'S', 'S', 'A', 'P', 'N', '0', '0'}, PoseNetwork::kVersion, "pose network"};
  const std::vector<std::byte> whole = ReadContainer(folder / "a.ossanet", format);
  // people, then of the first layer: inputs, outputs, how many weights, weights of two bytes.
  constexpr size_t kInputs = sizeof(uint64_t), kCount = kInputs + 2 * sizeof(uint32_t);
  constexpr size_t kWeights = kCount + sizeof(uint64_t);
  const auto refuse = [&](size_t place, uint8_t byte, const std::string& field) {
    std::vector<std::byte> odd = whole;
    odd[place] = std::byte{byte};
    ExpectRefused([&] { PoseNetwork::FromBytes(odd, "x.ossanet"); }, field);
  };
  EXPECT_NO_THROW(PoseNetwork::FromBytes(whole, "x.ossanet"));
  refuse(kInputs, 0, "units");
  refuse(kInputs + 2, 1, "units");
  refuse(kInputs, 4, "weights");  // four inputs have more of them
  refuse(kCount, static_cast<uint8_t>(std::to_integer<int>(whole[kCount]) - 1), "weights");
  refuse(kWeights + 1, 0x7f, "weights");  // 1.7e38
  std::vector<std::byte> longer = whole;
  longer.push_back(std::byte{0});
  ExpectRefused([&] { PoseNetwork::FromBytes(longer, "x.ossanet"); }, "x.ossanet");
}

TEST(PoseNetwork, IsBuiltFromTrainedWeights) {
  const auto layers = SilentLayers();
  std::vector<float> numbers;
  for (const Convolution& layer : layers) {
    for (const auto count : {layer.inputs(), layer.weight.cols(), Eigen::Index{layer.size},
                             Eigen::Index{layer.stride}}) {
      numbers.push_back(static_cast<float>(count));
    }
    numbers.insert(numbers.end(), layer.weight.data(), layer.weight.data() + layer.weight.size());
    numbers.insert(numbers.end(), layer.bias.data(), layer.bias.data() + layer.bias.size());
  }
  numbers.back() = 3.0F;
  const auto network = PoseNetwork::FromNumbers(numbers, 5, "w.npy");
  EXPECT_EQ(network.layers().back().bias[5 * kJointCount - 1], 3.0F);
  const auto refuse = [](const std::vector<float>& of, const std::string& named) {
    ExpectRefused([&] { PoseNetwork::FromNumbers(of, 5, "w.npy"); }, named);
  };
  refuse({numbers.begin(), numbers.end() - 1}, "w.npy: expected more numbers");
  numbers.push_back(0.0F);
  refuse(numbers, "w.npy: expected no more numbers");
  numbers[0] = std::numeric_limits<float>::quiet_NaN();
  refuse(numbers, "w.npy: layer 1");
}

}  // namespace
}  // namespace ossa::recon
