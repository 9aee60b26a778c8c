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
#include "tests/tools/commands/tracked_folders.h"
#include "tools/viewer/viewer.h"

namespace ossa::commands {
namespace {

using std::chrono::milliseconds;
using test::CommandResult;
using test::LineCount;
using test::RunOssa;
using test::TemporaryFolder;
using tracker::ModelOrNothing;

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

TEST(ViewCommand, ReportsAnUnpluggedCamera) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 3);
  auto command =
      test::StartOssa({"view", "openni:ossa://" + folder.path().string(), "--port", "0"});
  EXPECT_TRUE(command.WaitForError("the device is unplugged", test::kCommandTimeout));
  command.Signal(SIGINT);
  EXPECT_FALSE(command.Wait(test::kCommandTimeout).timed_out);
}

// It restarted playback in a busy loop, which uses up a second of processor time at once.
TEST(ViewCommand, DoesNotBusyLoopOverARecordingOfOneFrame) {
  const TemporaryFolder folder;
  std::ofstream(folder / "one.jsonl") << R"({"frame":0,"time_s":0,"bodies":[]})"
                                      << "\n";
  const CommandResult result = test::RunProgram(
      {"/bin/bash", "-c", R"(ulimit -t 1; timeout -s INT 3 "$1" view "$2" --port 0)", "shell",
       test::OssaPath(), (folder / "one.jsonl").string()});
  constexpr int kEndedByTimeout = 124;
  EXPECT_EQ(result.exit_status, kEndedByTimeout) << result.err;
}

TEST(ViewCommand, ReportsAPortInUseInOneLine) {
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

// The error appeared only when the record button was pressed.
TEST(ViewCommand, ReportsAnUnwritableRecordingFolderAtStart) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const CommandResult result = RunOssa({"view", (folder / "x.jsonl").string(), "--once", "--port",
                                        "0", "--record-to", (folder / "nowhere").string()});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("nowhere"), std::string::npos) << result.err;
}

TEST(ViewCommand, NamesAFileWithoutSkeletons) {
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

TEST(ViewCommand, ReportsTrackingOptionsGivenForASkeletonFile) {
  const TemporaryFolder folder;
  WriteSkeletons(folder / "x.jsonl");
  const CommandResult result =
      RunOssa({"view", (folder / "x.jsonl").string(), "--port", "0", "--once", "--physics", "on"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("x.jsonl: --physics is for a source that is tracked"),
            std::string::npos)
      << result.err;
}

TEST(ViewCommand, RefusesALearnedMethodWithoutItsFile) {
  const TemporaryFolder folder;
  const CommandResult result = RunOssa({"view", folder.path().string(), "--method", "full-gp"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("--learned"), std::string::npos) << result.err;
}

TEST(ViewCommand, AcceptsTheModelAndMountOptionsOfTrack) {
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

/// The answer of the page at this port to GET `target`.
std::string Get(const std::string& port, const std::string& target) {
  const char* get =
      R"(exec 3<>/dev/tcp/127.0.0.1/$1; printf 'GET %s HTTP/1.0\r\nHost: 127.0.0.1\r\n\r\n' "$2")"
      R"( >&3; cat <&3 | sed '1,/^\r$/d')";
  return test::RunProgram({"/bin/bash", "-c", get, "shell", port, target}).out;
}

std::string FreePort() {
  viewer::ViewerOptions any;
  any.port = 0;
  return std::to_string(viewer::Viewer(any).port());
}

/// The page of `ossa view` with these arguments, and the text on stderr.
std::pair<int, std::string> SkinOf(std::vector<std::string> arguments) {
  const std::string port = FreePort();
  arguments.insert(arguments.begin(), "view");
  arguments.insert(arguments.end(), {"--port", port});
  auto command = test::StartOssa(arguments);
  EXPECT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  const auto bytes = static_cast<int>(Get(port, "/mesh").size());
  command.Signal(SIGINT);
  return {bytes, command.Wait(test::kCommandTimeout).err};
}

// Of a custom body, and of a skeleton file: a .glb exported by the page has the mesh, too.
TEST(ViewCommand, ShowsBodiesWithTheNamedSkin) {
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

/// The skeletons that a page shows of a recording of so many frames.
std::string SkeletonsShown(const std::string& images, int frames,
                           const std::vector<std::string>& more) {
  const std::string port = FreePort();
  std::vector<std::string> arguments = {"view", images, "--port", port};
  arguments.insert(arguments.end(), more.begin(), more.end());
  auto command = test::StartOssa(arguments);
  EXPECT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  const auto give_up = std::chrono::steady_clock::now() + test::kCommandTimeout;
  std::string lines;
  while (LineCount(lines) < frames && std::chrono::steady_clock::now() < give_up) {
    lines = Get(port, "/lines?layer=final&from=0&count=" + std::to_string(frames));
  }
  command.Signal(SIGINT);
  EXPECT_FALSE(command.Wait(test::kCommandTimeout).timed_out);
  return lines;
}

TEST(ViewCommand, FitOptionsChangeTheShownSkeletons) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  constexpr int kFrames = 3;
  WriteWalk(folder / "in", kFrames);
  const std::string images = (folder / "in").string(), me = folder / "me.ossaperson";
  ASSERT_EQ(RunOssa({"track", images, "--save-person", me, "--quiet"}).exit_status, 0);
  const std::string usual = SkeletonsShown(images, kFrames, {});
  ASSERT_EQ(LineCount(usual), kFrames);
  EXPECT_EQ(SkeletonsShown(images, kFrames, {"--fit", "on"}), usual);
  const std::string without = SkeletonsShown(images, kFrames, {"--fit", "off"});
  EXPECT_NE(without, usual);
  EXPECT_EQ(SkeletonsShown(images, kFrames, {"--surface", "none"}), without);
  EXPECT_NE(SkeletonsShown(images, kFrames, {"--person", me}), usual);
}

TEST(ViewCommand, RefusesImpossibleFitsLikeTrack) {
  const auto refused = [](std::vector<std::string> words) {
    words.insert(words.begin(), {"view", "in"});
    const CommandResult result = RunOssa(words);
    EXPECT_EQ(result.exit_status, 2) << result.err;
    return result.err;
  };
  EXPECT_NE(refused({"--fit", "on", "--surface", "none"}).find("--fit on: expected --surface"),
            std::string::npos);
  EXPECT_NE(refused({"--fit", "off", "--person", "me.ossaperson"}).find("--person: expected a"),
            std::string::npos);
  EXPECT_NE(refused({"--users", "1", "--person", "a", "--person", "b"}).find("at most 1 files"),
            std::string::npos);
}

TEST(ViewCommand, AcceptsASingleImageAsSource) {
  const TemporaryFolder folder;
  std::ofstream(folder / "still.png") << "no image\n";
  const CommandResult result =
      RunOssa({"view", (folder / "still.png").string(), "--port", "0", "--once"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("PNG"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace ossa::commands
