// Common behaviour of the scripts tools/train_*: help, and errors before anything is written.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::tests {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;

class TrainScript : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "mocap");
    std::ofstream(folder_ / "ossa") << "#!/bin/sh\necho \"$@\"\n";
    fs::permissions(folder_ / "ossa", fs::perms::owner_all);
  }
  CommandResult Run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), test::SourceFolder() / "tools" / GetParam());
    return test::RunProgram(arguments);
  }

  test::TemporaryFolder folder_;
};

TEST_P(TrainScript, HelpDescribesOutputsAndArguments) {
  const CommandResult help = Run({"--help"});
  EXPECT_EQ(help.exit_status, 0);
  EXPECT_NE(help.out.find(std::string("tools/") + GetParam() + " "), std::string::npos) << help.out;
  EXPECT_NE(help.out.find("OSSA is the command"), std::string::npos) << help.out;
  EXPECT_EQ(help.err, "");
}

TEST_P(TrainScript, RefusesAWrongNumberOfArguments) {
  EXPECT_EQ(Run({}).exit_status, 2);
  const CommandResult one = Run({folder_ / "mocap"});
  EXPECT_EQ(one.exit_status, 2);
  EXPECT_NE(one.err.find("OSSA is the command"), std::string::npos) << one.err;
  EXPECT_EQ(Run({"a", "b", "c", "d"}).exit_status, 2);
}

TEST_P(TrainScript, NamesAMissingFolderOrCommandAndWritesNothing) {
  const CommandResult folder = Run({folder_ / "nosuch", folder_ / "work", folder_ / "ossa"});
  EXPECT_EQ(folder.exit_status, 1);
  EXPECT_NE(folder.err.find("nosuch: expected a folder"), std::string::npos) << folder.err;
  const CommandResult command = Run({folder_ / "mocap", folder_ / "work", folder_ / "nocommand"});
  EXPECT_EQ(command.exit_status, 1);
  EXPECT_NE(command.err.find("nocommand: expected the command"), std::string::npos) << command.err;
  EXPECT_EQ(test::LineCount(command.err), 1);
  EXPECT_FALSE(fs::exists(folder_ / "work"));
}

constexpr const char* kOfMocap[] = {"train_ceiling",      "train_correction", "train_model",
                                    "train_pose_network", "train_prior",      "train_refinement",
                                    "train_surface"};
INSTANTIATE_TEST_SUITE_P(OfMocap, TrainScript, ::testing::ValuesIn(kOfMocap));
INSTANTIATE_TEST_SUITE_P(OfRecordings, TrainScript, ::testing::Values("train_kinect_correction"));

// train_correction exited with 1 without a message; others named an internal folder.
class TrainOfMocap : public TrainScript {};

TEST_P(TrainOfMocap, NamesAFolderWithoutClipsOfTrainingSubjects) {
  std::ofstream(folder_ / "mocap" / "02_01.bvh") << "BVH";  // subject 2 is for tests
  const CommandResult run = Run({folder_ / "mocap", folder_ / "work", folder_ / "ossa"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("mocap: expected clips of the train part"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1);
  EXPECT_EQ(run.out, "");
}

INSTANTIATE_TEST_SUITE_P(Each, TrainOfMocap, ::testing::ValuesIn(kOfMocap));

TEST(TrainCorrection, LearnsOnEverySecondClipOfTrainingSubjects) {
  const test::TemporaryFolder folder;
  const fs::path mocap = fs::path(folder / "a b");
  fs::create_directories(mocap);
  for (const char* clip : {"01_01", "02_01", "05_01", "06_01", "09_01", "10_01"}) {
    std::ofstream(mocap / (std::string(clip) + ".bvh")) << "BVH";
  }
  const CommandResult run = test::RunProgram(
      {test::SourceFolder() / "tools/train_correction", mocap, folder / "work", "/bin/echo"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("learn --correction-only --out body.ossagp --observed 05_01.seen.jsonl "
                         "--truth 05_01/truth.jsonl --observed 10_01.seen.jsonl "
                         "--truth 10_01/truth.jsonl\n"),
            std::string::npos)
      << run.out;
}

}  // namespace
}  // namespace ossa::tests
