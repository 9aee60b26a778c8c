#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <fstream>

#include "depth/image/depth_png.h"
#include "depth/image/turn.h"
#include "depth/sensor/frame_source.h"
#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using std::chrono::milliseconds;
using test::CommandResult;
using test::ExampleFrame;
using test::RunOssa;
using test::TemporaryFolder;
using test::WriteExampleFolder;

std::string Bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

int FramesIn(const std::filesystem::path& path) {
  const auto source = depth::OpenSource(path.string());
  int count = 0;
  while (source->Read(test::kCommandTimeout).status == depth::ReadStatus::kFrame) ++count;
  return count;
}

TEST(RecordCommand, RecordingOfARecordingIsIdentical) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 5);
  const std::string first = (folder / "a.oni").string();
  const std::string second = (folder / "b.oni").string();
  const CommandResult result = RunOssa({"record", folder.path().string(), "--out", first});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_EQ(result.out, first + ": 5 frames, 0.2 s, 0 dropped\n");
  EXPECT_EQ(RunOssa({"record", first, "--out", second, "--quiet"}).exit_status, 0);
  EXPECT_EQ(Bytes(first), Bytes(second));
  const auto source = depth::OpenSource(second);
  EXPECT_EQ(source->Read(test::kCommandTimeout).frame.depth_mm, ExampleFrame(0).depth_mm);
}

TEST(RecordCommand, ReportsOptionsThatItDoesNotRead) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  std::vector<std::string> command = {
      "record", folder.path().string(), "--out", folder / "x.oni", "--wait", "1", "--rotate", "90"};
  const CommandResult result = RunOssa(command);
  EXPECT_EQ(result.exit_status, 0);
  EXPECT_NE(result.err.find("--wait is not read for a recording"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("--rotate is not read by record"), std::string::npos) << result.err;
  command.push_back("--quiet");
  EXPECT_EQ(RunOssa(command).err, "");
}

TEST(RecordCommand, RecordsMirroredImagesUnmirrored) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  const std::string out = (folder / "x.oni").string();
  const std::vector<std::string> command = {"record",   folder.path().string(), "--out",     out,
                                            "--camera", "30,30,14,11.5",        "--mirrored"};
  EXPECT_EQ(RunOssa(command).exit_status, 0);
  const auto source = depth::OpenSource(out);
  EXPECT_NEAR(source->camera().cx, 17.0, 1e-3);
  const depth::DepthFrame frame = source->Read(test::kCommandTimeout).frame;
  EXPECT_EQ(depth::Unmirrored(frame).depth_mm, ExampleFrame(0).depth_mm);
}

TEST(RecordCommand, StopsAfterTheGivenSeconds) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 40);
  const std::string out = (folder / "x.oni").string();
  EXPECT_EQ(RunOssa({"record", folder.path().string(), "--out", out, "--seconds", "1"}).exit_status,
            0);
  EXPECT_EQ(FramesIn(out), 30);
}

TEST(RecordCommand, RecordsALiveDeviceToItsEnd) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 60);
  const std::string out = (folder / "x.oni").string();
  const CommandResult result = RunOssa(
      {"record", "openni:ossa://" + folder.path().string(), "--out", out, "--patience", "2"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_GE(FramesIn(out), 5) << "all sixty, unless the machine is busy";
}

// The command prints "recording" on stderr with its first frame.
auto StartEndlessRecording(const TemporaryFolder& folder, const std::string& out) {
  return test::StartOssa({"record", "openni:ossa://" + folder.path().string() + "?loop=1", "--out",
                          out, "--seconds", "1000"});
}

TEST(RecordCommand, CtrlCLeavesACompleteFile) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 10);
  const std::string out = (folder / "x.oni").string();
  auto running = StartEndlessRecording(folder, out);
  ASSERT_TRUE(running.WaitForError("recording", test::kCommandTimeout));
  running.Signal(SIGINT);
  const CommandResult result = running.Wait(test::kCommandTimeout);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_GE(FramesIn(out), 1);
}

TEST(RecordCommand, LeavesNothingUnderTheFinalNameWhenKilled) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 10);
  const std::string out = (folder / "x.oni").string();
  auto running = StartEndlessRecording(folder, out);
  ASSERT_TRUE(running.WaitForError("recording", test::kCommandTimeout));
  running.Signal(SIGKILL);
  EXPECT_EQ(running.Wait(test::kCommandTimeout).exit_status, 128 + SIGKILL);
  EXPECT_FALSE(std::filesystem::exists(out));
  const auto partials = [&folder] {
    const std::filesystem::directory_iterator files(folder.path());
    return std::count_if(begin(files), end(files), [](const auto& entry) {
      return entry.path().string().find(".partial-") != std::string::npos;
    });
  };
  EXPECT_EQ(partials(), 1);
  EXPECT_EQ(RunOssa({"record", folder.path().string(), "--out", out, "--quiet"}).exit_status, 0);
  EXPECT_EQ(partials(), 1) << "the next to write the same file leaves it";
}

// `ulimit -f` counts kilobytes; a frame has more than two.
TEST(RecordCommand, ReportsTheFramesKeptOnAFullDisk) {
  const TemporaryFolder folder;
  constexpr int kFrames = 40;
  WriteExampleFolder(folder.path(), kFrames);
  const std::string out = (folder / "x.oni").string();
  for (const char* kilobytes : {"6", "13", "40"}) {
    const CommandResult result = test::RunProgram(
        {"/bin/bash", "-c", R"(ulimit -f "$1"; exec "$2" record "$3" --out "$4" --quiet)", "shell",
         kilobytes, test::OssaPath(), folder.path().string(), out});
    EXPECT_EQ(result.exit_status, 1);
    const int kept = FramesIn(out);
    EXPECT_GE(kept, 1);
    EXPECT_LT(kept, kFrames);
    const std::string begin =
        "ossa: " + out + ": writing failed: is the disk full? " + std::to_string(kept) + " of ";
    EXPECT_TRUE(result.err.starts_with(begin)) << result.err << begin;
    EXPECT_TRUE(result.err.ends_with(" frames were kept\n")) << result.err;
    EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
  }
}

TEST(RecordCommand, WaitsForADeviceToAppear) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "soon");
  WriteExampleFolder(folder / "soon", 10);
  const std::string out = (folder / "x.oni").string();
  auto running = test::StartOssa({"record", "openni:ossa://" + (folder / "late").string(), "--out",
                                  out, "--wait", "60", "--patience", "2"});
  ASSERT_TRUE(running.WaitForError("waiting for openni:ossa://", test::kCommandTimeout));
  std::filesystem::rename(folder / "soon", folder / "late");
  const CommandResult result = running.Wait(test::kCommandTimeout);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_GE(FramesIn(out), 1);
}

TEST(RecordCommand, CtrlCEndsTheWaitForADevice) {
  const TemporaryFolder folder;
  const std::string out = (folder / "x.oni").string();
  auto running = test::StartOssa({"record", "openni:", "--out", out, "--wait", "1000"});
  ASSERT_TRUE(running.WaitForError("waiting for openni:", test::kCommandTimeout));
  running.Signal(SIGINT);
  const CommandResult result = running.Wait(test::kCommandTimeout);
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("no OpenNI2 device found"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(RecordCommand, FailsWithACompleteFileWhenADeviceStopsDelivering) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 10);
  const std::string out = (folder / "x.oni").string();
  const CommandResult result =
      RunOssa({"record", "openni:ossa://" + folder.path().string() + "?stall_after=3", "--out", out,
               "--patience", "2", "--quiet"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("delivers no frames"), std::string::npos) << result.err;
  EXPECT_EQ(test::LineCount(result.err), 1);
  EXPECT_GE(FramesIn(out), 1);
}

TEST(RecordCommand, KeepsTheFramesBeforeOneThatCannotBeRecorded) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  WriteExampleFolder(folder / "in", 4, 256, 136);
  depth::DepthFrame many = ExampleFrame(0, 256, 136);  // different depths: .oni has no more
  for (size_t i = 0; i < many.depth_mm.size(); ++i) {
    many.depth_mm[i] = static_cast<uint16_t>(500 + i * 7919 % many.depth_mm.size());
  }
  depth::WriteDepthPng(folder / "in" / "000003.png", many.view());
  const auto out = folder / "x.oni";
  const CommandResult result = RunOssa(
      {"record", "openni:ossa://" + (folder / "in").string(), "--out", out.string(), "--quiet"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("32767 different depths"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("frames before it are in"), std::string::npos) << result.err;
  EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
  EXPECT_GE(FramesIn(out), 1);
}

TEST(RecordCommand, ReportsErrorsInOneLine) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 3);
  const std::string out = (folder / "x.oni").string();
  struct Case {
    std::vector<std::string> arguments;
    int exit_status;
    const char* message;
  };
  for (const Case& bad : std::vector<Case>{
           {{"record"}, 2, "SOURCE is required"},
           {{"record", "x"}, 2, "--out is required"},
           {{"record", "", "--out", out}, 2, "SOURCE: expected a value, found ''"},
           {{"record", "x", "--out", ""}, 2, "--out: expected a value, found ''"},
           {{"record", "x", "--out", "x.png"}, 2, "ends in .oni"},
           {{"record", "x", "--out", out, "--seconds", "-1"}, 2, "--seconds"},
           {{"record", "/nowhere", "--out", out}, 1, "/nowhere: expected"},
           {{"record", "openni:", "--out", out}, 1, "no OpenNI2 device found"},
           {{"record", "openni:", "--out", out, "--camera", "1,2"}, 2, "--camera: expected"},
           {{"record", "x", "--out", out, "--patience", "nan"}, 2, "a finite number"},
           {{"record", folder.path().string(), "--out", out, "--depth-format", "x"}, 2, "swapped"},
           {{"record", folder.path().string(), "--out", out, "--depth-format", "disparity",
             "--depth-scale", "1000"},
            2,
            "--depth-scale: expected none with"},
           {{"record", "openni:", "--out", out, "--fps", "0"}, 2, "--fps"},
           {{"record", folder.path().string(), "--out", "/nowhere/x.oni", "--quiet"},
            1,
            "cannot be written"}}) {
    const CommandResult result = RunOssa(bad.arguments);
    EXPECT_EQ(result.exit_status, bad.exit_status) << result.err;
    EXPECT_NE(result.err.find(bad.message), std::string::npos) << result.err;
    EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(out));
  }
}

TEST(RecordCommand, SkipsAndReportsUnreadableFrames) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 3);
  std::ofstream(folder / "000001.png") << "no PNG";
  const std::string out = folder / "x.oni";
  const CommandResult result = RunOssa({"record", folder.path().string(), "--out", out, "--quiet"});
  EXPECT_EQ(result.exit_status, 0);
  EXPECT_NE(result.err.find("skipped 1 of 3 frames"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("000001.png: byte 0"), std::string::npos) << result.err;
  EXPECT_EQ(depth::OpenSource(out)->frame_count(), 2);
}

// Debian puts fakenect's libfreenect beside the real one.
const char* const kFakenect = "/usr/lib/x86_64-linux-gnu/fakenect";

TEST(RecordCommand, WritesDumpsThatTheKinectDriverPlaysBitExactly) {
  if (!std::filesystem::is_directory(kFakenect)) GTEST_SKIP() << "no fakenect: " << kFakenect;
  const TemporaryFolder folder;
  const std::string dump = (folder / "dump").string();
  const std::string out = (folder / "x.oni").string();
  constexpr int kFrames = 6;
  WriteExampleFolder(folder.path(), kFrames, 640, 480);
  EXPECT_EQ(RunOssa({"record", folder.path().string(), "--out", dump, "--fakenect"}).exit_status,
            0);
  const CommandResult result = test::RunProgram(
      {"/usr/bin/env", std::string("LD_LIBRARY_PATH=") + kFakenect, "FAKENECT_PATH=" + dump,
       test::OssaPath(), "record", "openni:freenect://0", "--out", out, "--patience", "2"});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto source = depth::OpenSource(out);
  int frames = 0;
  for (int k = 0; k < kFrames; ++k) {  // in order, but that a busy machine may drop one
    const depth::ReadResult read = source->Read(test::kCommandTimeout);
    if (read.status != depth::ReadStatus::kFrame) break;
    while (k < kFrames && read.frame.depth_mm != ExampleFrame(k, 640, 480).depth_mm) ++k;
    EXPECT_LT(k, kFrames) << "frame " << frames << " is none of the dump's";
    ++frames;
  }
  EXPECT_GE(frames, 3);
}

// OpenNI2 itself crashes on names that are not ASCII and cuts off after 255 characters.
TEST(RecordCommand, AcceptsFileNamesOfAnyBytes) {
  const TemporaryFolder folder;
  for (const std::string& name :
       {std::string("caf\xC3\xA9 \xE6\x97\xA5"), std::string("\xFF\xFE\n"),
        std::string(120, 'x') + "/" + std::string(150, 'y')}) {
    const std::filesystem::path images = folder / name;
    std::filesystem::create_directories(images);
    WriteExampleFolder(images, 4);
    const std::string out = images.string() + ".oni";
    EXPECT_EQ(RunOssa({"record", images.string(), "--out", out}).exit_status, 0);
    EXPECT_EQ(FramesIn(out), 4);
    if (name.size() > 100) continue;  // of a URI OpenNI2 keeps no more
    const CommandResult live =
        RunOssa({"record", "openni:ossa://" + images.string(), "--out", out, "--patience", "2"});
    EXPECT_EQ(live.exit_status, 0) << live.err;
  }
  const CommandResult other = RunOssa({"record", "openni:caf\xC3\xA9", "--out", "x.oni"});
  EXPECT_EQ(other.exit_status, 1);
  EXPECT_NE(other.err.find("expected a URI in ASCII"), std::string::npos) << other.err;
}

TEST(RecordCommand, HelpExitsWithZero) {
  const CommandResult result = RunOssa({"record", "--help"});
  EXPECT_EQ(result.exit_status, 0);
  EXPECT_NE(result.out.find("--seconds"), std::string::npos);
}

}  // namespace
}  // namespace ossa::commands
