// `ossa crop`, the trainer of pose networks and `ossa pack-network` as processes: each reads what
// the one before wrote, and track fuses the prediction of the network into its joints.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/files/skeleton_io.h"
#include "recon/refine/pose_network.h"
#include "tests/recon/refine/pose_networks.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/learning/person_crops.h"

namespace ossa::commands {
namespace {

using recon::kCropCells;
using recon::kCropSide;
using recon::kJointCount;
using test::RunOssa;
using test::RunProgram;

constexpr size_t kNumpyHead = 128;            // bytes
constexpr auto kPython = "/usr/bin/python3";  // whose PyTorch is Debian's

std::string TextOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<float> NumbersOf(const std::string& path) {
  const std::string text = TextOf(path);
  if (text.size() < kNumpyHead) return {};
  std::vector<float> numbers((text.size() - kNumpyHead) / sizeof(float));
  std::memcpy(numbers.data(), text.data() + kNumpyHead, numbers.size() * sizeof(float));
  return numbers;
}

class PoseNetworkCommands : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  }

  std::string Crops(int frames) {
    const std::string data = folder_ / "data", crops = folder_ / "crops";
    auto run =
        RunOssa({"render", "--mocap", "authored", "--out", data, "--frames", std::to_string(frames),
                 "--size", "160x120", "--format", "packed", "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    run = RunOssa({"crop", data, "--out", crops, "--quiet"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return crops;
  }
  // Of the first person of the crops: as the tracker would cut them.
  recon::PersonCrop FirstCrop(const std::string& crops) const {
    const std::string bytes = TextOf(crops + "/crops.npy").substr(kNumpyHead);
    const double range_m = NumbersOf(crops + "/range.npy").at(0);
    recon::PersonCrop crop = recon::test::EmptyCrop(range_m);
    for (size_t c = 0; c < kCropCells; ++c) {
      const auto behind = static_cast<uint8_t>(bytes[c]);
      const auto shares = static_cast<uint8_t>(bytes[c + kCropCells]);
      crop.cells[c] = {static_cast<int16_t>(10 * (behind - 128)), static_cast<uint8_t>(shares / 5),
                       static_cast<uint8_t>(shares % 5)};
    }
    return crop;
  }
  bool HasTorch() const { return RunProgram({kPython, "-c", "import torch"}).exit_status == 0; }

  const test::TemporaryFolder folder_;
};

TEST_F(PoseNetworkCommands, CropsContainThePersonAndTheirJoints) {
  const std::string crops = Crops(40);
  const std::string bytes = TextOf(crops + "/crops.npy");
  EXPECT_EQ(bytes.size(), kNumpyHead + 40 * 2 * kCropCells);
  EXPECT_NE(bytes.find("'shape': (40, 2, 96, 96)"), std::string::npos);
  const std::vector<float> joints = NumbersOf(crops + "/joints.npy");
  ASSERT_EQ(joints.size(), 40U * 3 * kJointCount);
  int heads = 0, on_surface = 0;
  for (size_t person = 0; person < 40; ++person) {
    const size_t head = 3 * (person * kJointCount + recon::Index(recon::Joint::kHead));
    const auto index = [&](float m) {
      return static_cast<int>(std::lround((kCropSide - 1) / 2.0 - m / recon::kCropCell_m));
    };
    if (!std::isfinite(joints[head])) continue;
    const int column = index(joints[head]), row = index(joints[head + 1]);
    if (column < 0 || column >= kCropSide || row < 0 || row >= kCropSide) continue;
    const auto cell = static_cast<size_t>(row * kCropSide + column);
    const char* const of = &bytes[kNumpyHead + person * 2 * kCropCells];
    if (static_cast<uint8_t>(of[kCropCells + cell]) < 5) continue;  // no surface: hidden
    ++heads;
    const double behind_m = 0.01 * (static_cast<uint8_t>(of[cell]) - 128);
    // Skin lies before the joint, by less than a head is wide.
    on_surface += std::abs(behind_m + 0.1 - joints[head + 2]) < 0.12 ? 1 : 0;
  }
  EXPECT_GT(heads, 20);
  EXPECT_GT(on_surface, 9 * heads / 10);
}

TEST_F(PoseNetworkCommands, CropsAreTheSameBytesForAnyNumberOfThreads) {
  const std::string any = Crops(12);
  for (const char* threads : {"1", "3"}) {
    const std::string crops = folder_ / threads;
    const auto run =
        RunOssa({"crop", folder_ / "data", "--out", crops, "--threads", threads, "--quiet"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(any)) {
      const std::string name = entry.path().filename().string();
      EXPECT_TRUE(TextOf(crops + "/" + name) == TextOf(entry.path())) << name;
      ++files;
    }
    EXPECT_GE(files, 3U);
  }
}

TEST_F(PoseNetworkCommands, PackedNetworkGivesTheOutputsOfTheTrainer) {
  if (!HasTorch()) GTEST_SKIP() << "no PyTorch: python3-torch";
  const std::string crops = Crops(120), weights = folder_ / "w.npy", kept = folder_ / "w.pt";
  const std::string trainer = test::SourceFolder() / "tools/learning/train_pose_network.py";
  const auto trained = RunProgram({kPython, trainer, crops, "--validation", crops, "--out", weights,
                                   "--keep", kept, "--people", "400", "--batch", "32"},
                                  std::chrono::minutes(5));
  ASSERT_EQ(trained.exit_status, 0) << trained.err;
  const std::string net = folder_ / "w.ossanet";
  auto run = RunOssa({"pack-network", weights, "--out", net, "--people", "120"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  run = RunOssa({"info", net});
  EXPECT_NE(run.out.find("pose network of 13 layers and "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("learned from 120 people"), std::string::npos) << run.out;
  // The same person, by PyTorch: position of the joints in the crop and their standard deviation.
  const std::string script = fmt::format(
      "import sys; sys.path.insert(0, '{}')\n"
      "import numpy, torch, pose_network_model as t\n"
      "model = t.PoseNetwork(); model.load_state_dict(torch.load('{}')); model.eval()\n"
      "crops = torch.from_numpy(numpy.load('{}/crops.npy')[:1])\n"
      "place, scale = t.places(model(t.decode(crops)))\n"
      "out = torch.cat([place[0], 0.3 * scale[0].exp()[:, None]], dim=1)\n"
      "numpy.save('{}', out.detach().numpy())\n",
      (test::SourceFolder() / "tools/learning").string(), kept, crops,
      std::string(folder_ / "there.npy"));
  const auto there = RunProgram({kPython, "-c", script});
  ASSERT_EQ(there.exit_status, 0) << there.err;
  const std::vector<float> expected = NumbersOf(folder_ / "there.npy");
  ASSERT_EQ(expected.size(), 4U * kJointCount);
  const recon::PersonCrop crop = FirstCrop(crops);
  const recon::NetworkPose pose = recon::PoseNetwork::Load(net).Run(crop);
  for (size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Vector3d at_m = crop.Project(pose.joints_m.position_m[j]);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(at_m[axis], expected[4 * j + static_cast<size_t>(axis)], 0.01) << j;
    }
    EXPECT_NEAR(pose.error_m[j], expected[4 * j + 3], 0.02) << j;
  }
}

TEST_F(PoseNetworkCommands, KilledTrainingResumesToTheSameWeights) {
  if (!HasTorch()) GTEST_SKIP() << "no PyTorch: python3-torch";
  const std::string crops = Crops(40);
  const std::string folder = test::SourceFolder() / "tools/learning";
  const auto train = [&](const std::string& weights, std::vector<std::string> more) {
    // "kill N": after N steps, as the machine would that loses its power.
    const std::string script =
        "import os, sys; sys.path.insert(0, sys.argv.pop(1)); last = int(sys.argv.pop(1))\n"
        "import train_pose_network as t\n"
        "step = t.Training.step\n"
        "def step_or_die(training, *batch):\n"
        "    if training.steps == last: os.kill(os.getpid(), 9)\n"
        "    step(training, *batch)\n"
        "t.Training.step = step_or_die; t.main()\n";
    const std::string last = more.back();
    more.pop_back();
    std::vector<std::string> words = {kPython,   "-c",    script,     folder,     last,
                                      crops,     "--out", weights,    "--people", "80",
                                      "--batch", "8",     "--report", "0"};
    words.insert(words.end(), more.begin(), more.end());
    return RunProgram(words, std::chrono::minutes(5));
  };
  const std::string whole = folder_ / "whole.npy", halves = folder_ / "halves.npy";
  ASSERT_EQ(train(whole, {"-1"}).exit_status, 0);
  EXPECT_NE(train(halves, {"6"}).exit_status, 0);
  const auto refused = train(halves, {"--resume", "--rate", "0.1", "-1"});
  EXPECT_NE(refused.err.find("made with rate 0.003, not 0.1"), std::string::npos) << refused.err;
  const auto resumed = train(halves, {"--resume", "-1"});
  ASSERT_EQ(resumed.exit_status, 0) << resumed.err;
  EXPECT_NE(resumed.out.find("48 read before"), std::string::npos) << resumed.out;
  EXPECT_EQ(NumbersOf(whole), NumbersOf(halves));
  EXPECT_FALSE(std::filesystem::exists(halves + ".checkpoint"));
}

// It was reported at the first save or evaluation, as a traceback.
TEST_F(PoseNetworkCommands, TrainerReportsUnusableOutputAndValidationPathsAtStart) {
  if (!HasTorch()) GTEST_SKIP() << "no PyTorch: python3-torch";
  const std::string crops = Crops(3), nobody = folder_ / "nobody";
  std::filesystem::copy(crops, nobody);
  ASSERT_EQ(RunProgram({kPython, "-c",
                        "import sys, numpy; path = sys.argv[1] + '/joints.npy'\n"
                        "numpy.save(path, numpy.full_like(numpy.load(path), numpy.nan))",
                        nobody})
                .exit_status,
            0);
  const std::string trainer = test::SourceFolder() / "tools/learning/train_pose_network.py";
  const auto refuse = [&](const std::string& out, std::vector<std::string> more,
                          const std::string& named) {
    more.insert(more.begin(), {kPython, trainer, crops, "--out", out});
    const auto run = RunProgram(more);
    EXPECT_NE(run.exit_status, 0);
    EXPECT_EQ(run.err.find("Traceback"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(named), std::string::npos) << run.err;
  };
  const std::vector<std::string> few = {"--people", "4", "--batch", "4"};
  refuse(folder_ / "nowhere/w.npy", few, "nowhere/w.npy: cannot be written");
  refuse(folder_ / "w.npy", {"--people", "0"}, "--people");
  refuse(folder_ / "w.npy", {"--people", "4", "--batch", "4", "--validation", nobody},
         "nobody: expected people");
}

TEST_F(PoseNetworkCommands, PredictionIsFusedIntoTheRefinedJoints) {
  const std::string clip = folder_ / "clip", net = folder_ / "up.ossanet";
  auto run = RunOssa({"render", "--mocap", "authored", "--out", clip, "--frames", "3", "--sequence",
                      "--view", "front", "--size", "160x120", "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  // Predicts with high certainty that every joint is 2 m above the centre.
  auto layers = recon::test::SilentLayers();
  for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(kJointCount); ++j) {
    layers.back().bias.segment<5>(5 * j) << 0.0F, 0.0F, 10.0F, 0.0F, -5.0F;
  }
  recon::PoseNetwork(layers, 1, net).Save(net);
  const auto height_m = [&](const std::vector<std::string>& options) {
    const std::string out = folder_ / "joints.jsonl";
    std::vector<std::string> words = {"track",     clip,      "--out",  out,
                                      "--posture", "refined", "--quiet"};
    words.insert(words.end(), options.begin(), options.end());
    const auto tracked = RunOssa(words);
    EXPECT_EQ(tracked.exit_status, 0) << tracked.err;
    const auto clips = recon::ReadSkeletonClips(out);
    return clips.at(0)
        .sequence.frames.at(0)
        .bodies.at(0)
        .joints[recon::Joint::kSpine]
        .value()
        .position_m.y();
  };
  const double without_m = height_m({"--pose-network", "none"}), by_default_m = height_m({});
  EXPECT_GT(height_m({"--pose-network", net}), without_m + 1.0);
  EXPECT_EQ(height_m({"--pose-network", "shipped"}), by_default_m);
  EXPECT_NE(by_default_m, without_m);
  EXPECT_LT(std::abs(by_default_m - without_m), 0.1);
  const auto none = RunOssa(
      {"track", clip, "--out", folder_ / "x.jsonl", "--pose-network", folder_ / "no.ossanet"});
  EXPECT_EQ(none.exit_status, 1);
  EXPECT_EQ(test::LineCount(none.err), 1) << none.err;
  EXPECT_NE(none.err.find("no.ossanet"), std::string::npos) << none.err;
}

TEST(PackNetworkCommand, RefusesFilesWithoutWeightsInOneLine) {
  const test::TemporaryFolder folder;
  const std::string weights = folder / "w.npy", out = folder / "x.ossanet";
  const auto refuse = [&](const std::string& text, const std::string& named) {
    std::ofstream(weights, std::ios::binary) << text;
    const auto run = RunOssa({"pack-network", weights, "--out", out});
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
    EXPECT_NE(run.err.find("w.npy: " + named), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  };
  const auto numpy = [](const std::string& type, const std::string& shape) {
    std::string head =
        fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
    head.resize(117, ' ');
    return std::string("\x93NUMPY\x01\0v\0", 10) + head + "\n";
  };
  refuse("", "expected a NumPy file");
  refuse(std::string(200, 'x'), "expected a NumPy file");
  refuse(numpy("<f8", "3,"), "expected float32 numbers of one dimension");
  refuse(numpy("<f4", "3, 4"), "expected float32 numbers of one dimension");
  refuse(numpy("<f4", "99999999999,"), "expected float32 numbers of one dimension");
  refuse(std::string("\x93NUMPY\x01\0\x17\0", 10) + "'<f4' 'shape': (1234567", "expected float32");
  refuse(numpy("<f4", "3,") + "12345678", "expected as many numbers as its head says");
  refuse(numpy("<f4", "3,") + std::string(12, '\0'), "expected more numbers");
  EXPECT_EQ(RunOssa({"pack-network", weights, "--out", folder / "x.ossa"}).exit_status, 2);
  const auto missing = RunOssa({"crop", folder / "nothing", "--out", folder / "crops"});
  EXPECT_EQ(missing.exit_status, 1);
  EXPECT_EQ(test::LineCount(missing.err), 1) << missing.err;
  EXPECT_NE(missing.err.find("nothing"), std::string::npos) << missing.err;
}

}  // namespace
}  // namespace ossa::commands
