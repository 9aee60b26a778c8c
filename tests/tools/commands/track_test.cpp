#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <thread>

#include "recon/files/skeleton_io.h"
#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/commands/tracked_folders.h"

namespace ossa::commands {
namespace {

using std::chrono::milliseconds;
using test::CommandResult;
using test::LineCount;
using test::RunningCommand;
using test::RunOssa;
using test::StartOssa;
using test::TemporaryFolder;
using test::WriteExampleFolder;

TEST(TrackCommand, ReportsThatNobodyWasFoundAndPossibleCauses) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  WriteFlat(folder / "in", 2000, 2);
  const CommandResult result = TrackTo(folder / "in", folder / "x.jsonl");
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("nobody was found, by a camera of f 144 px"), std::string::npos)
      << result.err;
  const CommandResult quiet = TrackTo(folder / "in", folder / "y.jsonl", {"--quiet"});
  EXPECT_EQ(quiet.err, "");
  WriteWalk(folder / "walk", 2);
  const CommandResult walk = TrackTo(folder / "walk", folder / "z.jsonl");
  EXPECT_EQ(walk.err.find("nobody"), std::string::npos) << walk.err;
}

TEST(TrackCommand, NamesAMissingModel) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  const CommandResult result =
      TrackTo(folder.path(), folder / "x.jsonl", {"--model", "/nowhere/m.ossa"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("/nowhere/m.ossa"), std::string::npos) << result.err;
}

TEST(TrackCommand, WrongUsageExitsWithTwo) {
  EXPECT_EQ(RunOssa({"track"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"track", "."}).exit_status, 2);
  EXPECT_EQ(RunOssa({"track", ".", "--out", "x.jsonl", "--users", "7"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"track", ".", "--out", "x.jsonl", "--seed", "-1"}).exit_status, 2);
  EXPECT_EQ(
      RunOssa({"track", ".", "--out", "x.jsonl", "--frames", "99999999999999999999"}).exit_status,
      2);
  EXPECT_EQ(RunOssa({"track", ".", "--out", "x.jsonl", "--method", "magic"}).exit_status, 2);
}

TEST(TrackCommand, ReportsFilesThatTheMethodDoesNotRead) {
  const auto said = [](std::vector<std::string> options) {
    std::vector<std::string> arguments = {"track",   "/nonexistent", "--out",
                                          "x.jsonl", "--method",     "kalman"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult result = RunOssa(arguments);
    EXPECT_EQ(result.exit_status, 1);  // for what is to be tracked
    return result.err.find(options[options.size() - 2] + " is not read by --method kalman") !=
           std::string::npos;
  };
  for (const char* option : {"--refinement", "--learned", "--prior", "--database"})
    EXPECT_TRUE(said({option, "x.file"})) << option;
  // "none" is no file, and raw joints may be refined.
  EXPECT_FALSE(said({"--refinement", "none"}));
  EXPECT_FALSE(said({"--learned", "none"}));
  EXPECT_FALSE(said({"--posture", "refined", "--refinement", "/no.refine"}));
}

TEST(TrackCommand, ReportsThatPortIsNotReadWithoutView) {
  const std::vector<std::string> words = {"track", "in", "--out", "x.jsonl", "--port", "9"};
  const auto says_so = [](std::vector<std::string> all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
    const std::string err = RunOssa(all).err;
    return err.find("ossa: --port is not read without --view\n") != std::string::npos;
  };
  EXPECT_TRUE(says_so(words, {}));
  EXPECT_FALSE(says_so(words, {"--quiet"}));
  EXPECT_FALSE(says_so(words, {"--view"}));
}

TEST(TrackCommand, BonesOfTheRecordingAreEqualInEveryFrame) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 20);
  const auto drift = [&](const char* bones) {
    const auto out = folder / (std::string(bones) + ".jsonl");
    const CommandResult result = TrackTo(folder / "in", out, {"--bones", bones}, "best");
    EXPECT_EQ(result.exit_status, 0) << result.err;
    double worst = 0.0;
    std::optional<recon::BoneLengths> first;
    for (const auto& frame : recon::ReadSkeletons(out.string()).frames) {
      if (frame.bodies.empty()) continue;
      const auto lengths_m =
          recon::MeasureBoneLengths(recon::ToTrackedPosture(frame.bodies[0]).posture);
      if (!first) first = lengths_m;
      for (size_t i = 1; i < recon::kJointCount; ++i)
        worst = std::max(worst, std::abs(lengths_m[i] / (*first)[i] - 1.0));
    }
    EXPECT_TRUE(first.has_value());
    return worst;
  };
  EXPECT_GT(drift("so-far"), 1e-3);
  EXPECT_LT(drift("recording"), 1e-3);
}

TEST(TrackCommand, SeatedModeWritesTheUpperTenJoints) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 3);
  for (const char* name : {"x.jsonl", "x.trc"}) {
    const CommandResult result =
        TrackTo(folder / "in", folder / name, {"--mode", "seated"}, "best");
    ASSERT_EQ(result.exit_status, 0) << result.err;
    const recon::SkeletonSequence written = recon::ReadSkeletons((folder / name).string());
    const auto& frame = written.frames.back();
    ASSERT_FALSE(frame.bodies.empty());
    const auto& joints = frame.bodies[0].joints;
    EXPECT_EQ(std::count_if(joints.begin(), joints.end(), [](const auto& j) { return bool(j); }),
              10);
  }
}

TEST(TrackCommand, BonesOfTheRecordingNeedARecordingAndAMethodThatKeepsBones) {
  const TemporaryFolder folder;
  WriteFlat(folder.path(), 3000, 1);
  const auto out = folder / "x.jsonl";
  CommandResult result = TrackTo(folder.path(), out, {"--bones", "recording"}, "kalman");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("found kalman"), std::string::npos) << result.err;
  result =
      TrackTo("openni:ossa://" + folder.path().string(), out, {"--bones", "recording"}, "best");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("expected a recording"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(TrackCommand, CtrlCLeavesACompleteFile) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 20);
  const auto out = folder / "x.jsonl";
  RunningCommand command =
      StartOssa({"track", "openni:ossa://" + (folder / "in").string() + "?loop=1", "--out",
                 out.string(), "--method", "none", "--view", "--port", "0"});
  ASSERT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  std::this_thread::sleep_for(milliseconds(1500));
  command.Signal(SIGINT);
  const CommandResult result = command.Wait(test::kCommandTimeout);
  EXPECT_FALSE(result.timed_out);
  if (std::filesystem::exists(out)) {
    EXPECT_GE(recon::ReadSkeletons(out.string()).frames.size(), 1U);
  } else {
    EXPECT_NE(result.exit_status, 0) << "no frame came, and nobody said so";
  }
}

}  // namespace
}  // namespace ossa::commands
