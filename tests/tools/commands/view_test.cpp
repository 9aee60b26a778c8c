#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
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

TEST(ViewCommand, TakesTheModelsAndTheMountThatTrackTakes) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 1);
  const std::string images = folder.path().string();
  for (const char* option : {"--refinement", "--prior", "--pose-network"}) {
    const CommandResult result =
        RunOssa({"view", images, "--port", "0", "--once", option, folder / "none.bin"});
    EXPECT_NE(result.exit_status, 0) << option;
    EXPECT_NE(result.err.find("none.bin"), std::string::npos) << result.err;
  }
  EXPECT_EQ(RunOssa({"view", images, "--mount", "wall"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"view", images, "--port", "0", "--once", "--mount", "level"}).exit_status, 0);
}

/// Bytes of what the page of this port answers to /mesh, the triangles of a skin.
int MeshBytes(const std::string& port) {
  const char* get =
      R"(exec 3<>/dev/tcp/127.0.0.1/$1; printf 'GET /mesh HTTP/1.0\r\nHost: 127.0.0.1\r\n\r\n' >&3)"
      R"(; cat <&3 | sed '1,/^\r$/d' | wc -c)";
  const CommandResult got = test::RunProgram({"/bin/bash", "-c", get, "shell", port});
  return std::stoi("0" + got.out);
}

/// The page of `ossa view` with these arguments, and what was said.
std::pair<int, std::string> SkinOf(std::vector<std::string> arguments) {
  viewer::ViewerOptions any;
  any.port = 0;
  const std::string port = std::to_string(viewer::Viewer(any).port());
  arguments.insert(arguments.begin(), "view");
  arguments.insert(arguments.end(), {"--port", port});
  auto command = test::StartOssa(arguments);
  EXPECT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  const int bytes = MeshBytes(port);
  command.Signal(SIGINT);
  return {bytes, command.Wait(test::kCommandTimeout).err};
}

// Of a body of one's own, and of skeletons: a .glb that the page exports is dressed, too.
TEST(ViewCommand, BodiesWearTheSkinThatIsNamed) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const std::string skeletons = folder / "x.jsonl";
  constexpr int kTriangles = 1000 * 3 * 4;  // bytes of a body's: more than a thousand
  EXPECT_GT(SkinOf({skeletons}).first, kTriangles);
  EXPECT_EQ(SkinOf({skeletons, "--mesh", "none"}).first, 0);
  const auto shipped = test::SourceFolder() / "tools/tracker/shipped";
  std::filesystem::create_directory(folder / "images");
  test::WriteExampleFolder(folder / "images", 1);
  const std::vector<std::string> own = {folder / "images", "--surface",
                                        shipped / "body.ossasurface"};
  const auto [bare, said] = SkinOf(own);
  EXPECT_EQ(bare, 0);
  EXPECT_NE(said.find("the page shows no skin of it: --mesh FILE.ossamesh names one"),
            std::string::npos)
      << said;
  std::vector<std::string> dressed = own;
  dressed.insert(dressed.end(), {"--mesh", shipped / "body.ossamesh"});
  EXPECT_GT(SkinOf(dressed).first, kTriangles);
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
