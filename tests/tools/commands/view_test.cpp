#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using std::chrono::milliseconds;
using test::CommandResult;
using test::LineCount;
using test::RunOssa;
using test::TemporaryFolder;

void WriteSkeletons(const std::filesystem::path& path) {
  std::ofstream file(path);
  for (int i = 0; i < 3; ++i) {
    file << R"({"frame":)" << i << R"(,"time_s":)" << i / 30.0
         << R"(,"bodies":[{"id":1,"joints":{"Head":{"p":[0,0.5,2],"state":"tracked"}}}]})"
         << "\n";
  }
}

TEST(ViewCommand, ShowsASkeletonFileOnceAndEnds) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const CommandResult result =
      RunOssa({"view", (folder / "x.jsonl").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("watch at http://127.0.0.1:"), std::string::npos) << result.err;
}

TEST(ViewCommand, CtrlCEndsIt) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  auto command = test::StartOssa({"view", (folder / "x.jsonl").string(), "--port", "0"});
  ASSERT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  command.Signal(SIGINT);
  EXPECT_FALSE(command.Wait(test::kCommandTimeout).timed_out);
}

TEST(ViewCommand, SaysThatItsCameraIsUnplugged) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 3);
  auto command =
      test::StartOssa({"view", "openni:ossa://" + folder.path().string(), "--port", "0"});
  EXPECT_TRUE(command.WaitForError("the device is unplugged", test::kCommandTimeout));
  command.Signal(SIGINT);
  EXPECT_FALSE(command.Wait(test::kCommandTimeout).timed_out);
}

// It began anew without end: a second of processor time would be used up at once.
TEST(ViewCommand, ARecordingOfOneFrameIsShownAtItsLeisure) {
  const TemporaryFolder folder;
  std::ofstream(folder / "one.jsonl") << R"({"frame":0,"time_s":0,"bodies":[]})"
                                      << "\n";
  const CommandResult result = test::RunProgram(
      {"/bin/bash", "-c", R"(ulimit -t 1; timeout -s INT 3 "$1" view "$2" --port 0)", "shell",
       test::OssaPath(), (folder / "one.jsonl").string()});
  constexpr int kEndedByTimeout = 124;
  EXPECT_EQ(result.exit_status, kEndedByTimeout) << result.err;
}

TEST(ViewCommand, APortThatIsTakenIsOneLine) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  viewer::ViewerOptions any;
  any.port = 0;
  const viewer::Viewer taken(any);
  const CommandResult result = RunOssa(
      {"view", (folder / "x.jsonl").string(), "--once", "--port", std::to_string(taken.port())});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(std::to_string(taken.port())), std::string::npos);
}

// Whoever watches learned it when they pressed the button.
TEST(ViewCommand, WhereNothingCanBeRecordedIsSaidBeforeAnythingIsShown) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const CommandResult result = RunOssa({"view", (folder / "x.jsonl").string(), "--once", "--port",
                                        "0", "--record-to", (folder / "nowhere").string()});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("nowhere"), std::string::npos) << result.err;
}

TEST(ViewCommand, WhatIsNoSkeletonFileIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder / "x.jsonl") << "not json\n";
  const CommandResult result =
      RunOssa({"view", (folder / "x.jsonl").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("x.jsonl"), std::string::npos) << result.err;
  EXPECT_EQ(LineCount(result.err), 1) << "nobody is told where to watch what cannot be shown";
  EXPECT_EQ(RunOssa({"view"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"view", "x", "--camera", "wide"}).exit_status, 1) << "x comes first";
  EXPECT_EQ(RunOssa({"view", folder.path().string(), "--camera", "wide"}).exit_status, 2);
}

TEST(ViewCommand, OfSkeletonsWhatIsForTrackingIsSaidToBe) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const CommandResult result =
      RunOssa({"view", (folder / "x.jsonl").string(), "--port", "0", "--once", "--physics", "on"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("x.jsonl: --physics is for a source that is tracked"),
            std::string::npos)
      << result.err;
}

TEST(ViewCommand, AMethodThatLearnsNeedsWhatWasLearned) {
  const TemporaryFolder folder;
  const CommandResult result = RunOssa({"view", folder.path().string(), "--method", "full-gp"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("--learned"), std::string::npos) << result.err;
}

TEST(ViewCommand, AStillIsASource) {
  const TemporaryFolder folder;
  std::ofstream(folder / "still.png") << "no image\n";
  const CommandResult result =
      RunOssa({"view", (folder / "still.png").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("PNG"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace ossa::commands
