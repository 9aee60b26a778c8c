// `ossa prior` as a process: it writes a readable prior; wrong usage.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "depth/base/error.h"
#include "recon/body/standard_body.h"
#include "recon/models/posture_prior.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/tracker/shipped.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

TEST(PriorCommand, LearnsTheRequestedNumberOfModesAndInfoShowsIt) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossaprior";
  const auto run = RunOssa({"prior", "--mocap", "authored", "--modes", "12", "--hidden", "8",
                            "--walks", "1", "--epochs", "1", "--quiet", "--out", out});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(recon::PosturePrior::Load(out).correlation_time_s.size(), 12);
  EXPECT_EQ(recon::PosturePrior::Load(out).network.layers.at(0).bias.size(), 8);
  const auto info = RunOssa({"info", out});
  EXPECT_EQ(info.exit_status, 0) << info.err;
  EXPECT_NE(info.out.find("posture prior, 12 modes learned from "), std::string::npos) << info.out;
  EXPECT_NE(info.out.find(", 8 units "), std::string::npos) << info.out;
}

TEST(PriorCommand, WritesTheSameBytesForAnyNumberOfThreads) {
  const test::TemporaryFolder folder;
  std::vector<std::string> bytes;
  for (const char* threads : {"1", "3"}) {
    const std::string out = folder / (std::string(threads) + ".ossaprior");
    const auto run =
        RunOssa({"prior", "--mocap", "authored", "--modes", "12", "--hidden", "8", "--walks", "1",
                 "--epochs", "1", "--threads", threads, "--quiet", "--out", out});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    std::ifstream file(out, std::ios::binary);
    bytes.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  EXPECT_GT(bytes.at(0).size(), 1000U);
  EXPECT_TRUE(bytes.at(0) == bytes.at(1));
}

// Authored frames on the floor were weighted as captured ones. Where all frames are authored, the
// weight has no effect; 0.5, a power of two, is exact.
TEST(PriorCommand, AuthoredWeightAppliesToFloorMotionToo) {
  const test::TemporaryFolder folder;
  std::vector<std::string> bytes;
  for (const char* weight : {"0.5", "1"}) {
    const std::string out = folder / (std::string(weight) + ".ossaprior");
    const auto run =
        RunOssa({"prior", "--mocap", "authored", "--mocap", "authored-floor", "--modes", "12",
                 "--hidden", "0", "--authored-weight", weight, "--quiet", "--out", out});
    ASSERT_EQ(run.exit_status, 0) << run.err;
    std::ifstream file(out, std::ios::binary);
    bytes.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  EXPECT_EQ(bytes.at(0), bytes.at(1));
}

// Thirty frames of a person at rest, whose left arm is hidden after ten.
std::string LosingAnArm() {
  std::string lines;
  for (int i = 0; i < 30; ++i) {
    lines += fmt::format("{{\"frame\":{},\"time_s\":{},\"bodies\":[{{\"id\":1,\"joints\":{{", i,
                         i / 30.0);
    const recon::Posture posture = recon::StandardPosture({});
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const auto joint = static_cast<recon::Joint>(j);
      const Eigen::Vector3d p = posture[joint] + Eigen::Vector3d(0, 0, 2.5);
      const bool seen =
          i < 10 || (joint != recon::Joint::kHandLeft && joint != recon::Joint::kWristLeft &&
                     joint != recon::Joint::kElbowLeft);
      lines += fmt::format("{}\"{}\":{{\"p\":[{},{},{}],\"state\":\"{}\",\"confidence\":{}}}",
                           j == 0 ? "" : ",", recon::kJointNames[j], p.x(), p.y(), p.z(),
                           seen ? "tracked" : "not_tracked", seen ? 1 : 0);
    }
    lines += "}}]}\n";
  }
  return lines;
}

TEST(PriorCommand, TrackUsesTheNamedPrior) {
  const test::TemporaryFolder folder;
  const std::string prior = folder / "x.ossaprior", in = folder / "in.jsonl";
  std::ofstream(in) << LosingAnArm();
  ASSERT_EQ(
      RunOssa({"prior", "--mocap", "authored", "--modes", "3", "--hidden", "0", "--out", prior})
          .exit_status,
      0);
  const auto text = [&](const std::vector<std::string>& more, const std::string& name) {
    std::vector<std::string> arguments = {"reconstruct", in, "--out", folder / name, "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = RunOssa(arguments);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    std::ifstream file(folder / name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string shipped = text({}, "shipped.jsonl");
  EXPECT_TRUE(shipped != text({"--prior", prior}, "named.jsonl"));
  const std::string by_name = tracker::ShippedFile(recon::kShippedPrior).string();
  EXPECT_TRUE(shipped == text({"--prior", by_name}, "shipped_by_name.jsonl"));
  const auto bad = RunOssa({"reconstruct", in, "--out", folder / "bad.jsonl", "--prior", in});
  EXPECT_EQ(bad.exit_status, 1);
  EXPECT_EQ(test::LineCount(bad.err), 1) << bad.err;
  EXPECT_NE(bad.err.find("in.jsonl"), std::string::npos) << bad.err;
  tracker::ModelFiles files;
  files.prior = in;
  EXPECT_THROW(tracker::ModelSet::Load(files), InputError);
}

TEST(PriorCommand, ReportsErrorsInOneLine) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossaprior";
  EXPECT_EQ(RunOssa({"prior", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"prior", "--mocap", "authored", "--modes", "58", "--out", out}).exit_status,
            2);
  // Not a number of passes over each motion.
  EXPECT_EQ(RunOssa({"prior", "--mocap", "authored", "--authored-weight", "1e12", "--hidden", "0",
                     "--out", out})
                .exit_status,
            2);
  const auto run = RunOssa({"prior", "--mocap", "/nonexistent", "--out", out});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("/nonexistent"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

// tools/train_prior of these clips: the arguments of the command that it calls, one a line.
test::CommandResult TrainPrior(const std::vector<std::string>& clips) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directories(folder / "mocap");
  for (const std::string& clip : clips) std::ofstream(folder / "mocap" / clip) << "BVH";
  std::ofstream(folder / "ossa") << "#!/bin/sh\nprintf '%s\\n' \"$@\"\n";
  std::filesystem::permissions(folder / "ossa", std::filesystem::perms::owner_all);
  return test::RunProgram({test::SourceFolder() / "tools/train_prior", folder / "mocap",
                           folder / "x.ossaprior", folder / "ossa"});
}

TEST(TrainPrior, LeavesOutValidationAndTestSubjects) {
  const auto run = TrainPrior({"01_01.bvh", "02_01.bvh", "03_02.bvh", "07_01.bvh", "09_01.bvh",
                               "10_03.bvh", "12_01.bvh", "60_15.bvh", "102_01.bvh"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  for (const char* learned : {"authored", "/01_01.bvh", "/10_03.bvh", "/102_01.bvh"}) {
    EXPECT_NE(run.out.find(learned), std::string::npos) << learned << "\n" << run.out;
  }
  // Nor is the folder that contains them passed as a whole.
  for (const char* kept : {"/02_", "/03_", "/07_", "/09_", "/12_", "/60_", "/mocap\n"}) {
    EXPECT_EQ(run.out.find(kept), std::string::npos) << kept << "\n" << run.out;
  }
  for (const std::vector<std::string>& nobody :
       {std::vector<std::string>{}, {"02_01.bvh", "60_01.bvh"}}) {
    const auto refused = TrainPrior(nobody);
    EXPECT_EQ(refused.exit_status, 1);
    EXPECT_EQ(test::LineCount(refused.err), 1) << refused.err;
    EXPECT_NE(refused.err.find("found none"), std::string::npos) << refused.err;
  }
}

}  // namespace
}  // namespace ossa::commands
