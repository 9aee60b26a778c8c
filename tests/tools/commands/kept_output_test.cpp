// Results so far are kept: of interrupted runs, on full disks, of sources that fail.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <regex>
#include <thread>

#include "depth/image/depth_png.h"
#include "depth/sensor/frame_source.h"
#include "recon/files/skeleton_io.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using test::CommandResult;
using test::RunningCommand;
using test::TemporaryFolder;

constexpr int kMany = 5000;  // frames: more than any machine has done when the signal comes

// One image under many names.
void WriteLongFolder(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  test::WriteExampleFolder(folder, 1, 320, 240);
  for (int i = 1; i < kMany; ++i) {
    std::filesystem::create_symlink("000000.png",
                                    folder / (std::to_string(1000000 + i).substr(1) + ".png"));
  }
}

// Of "27 of 5000 frames": 27; -1 where there is no such text. The last one counts: it follows the
// progress.
long Kept(const CommandResult& result) {
  const std::regex words("([0-9]+) of " + std::to_string(kMany) + " frames");
  long kept = -1;
  for (std::sregex_iterator found(result.err.begin(), result.err.end(), words), end; found != end;
       ++found) {
    kept = std::stol((*found)[1]);
  }
  return kept;
}

// Sends the signal as soon as the command prints progress.
CommandResult Interrupted(const std::vector<std::string>& arguments, int signal,
                          const std::string& says) {
  RunningCommand command = test::StartOssa(arguments);
  EXPECT_TRUE(command.WaitForError(says, test::kCommandTimeout));
  command.Signal(signal);
  return command.Wait(test::kCommandTimeout);
}

long FramesIn(const std::filesystem::path& recording) {
  const auto source = depth::OpenSource(recording.string());
  long count = 0;
  while (source->Read(test::kCommandTimeout).status == depth::ReadStatus::kFrame) ++count;
  return count;
}

long SkeletonsIn(const std::filesystem::path& path) {
  return static_cast<long>(recon::ReadSkeletons(path).frames.size());
}

TEST(KeptOutput, OfAnInterruptedRecordingHasAllFramesReadSoFar) {
  const TemporaryFolder folder;
  WriteLongFolder(folder / "in");
  const auto out = folder / "x.oni";
  const CommandResult result =
      Interrupted({"record", (folder / "in").string(), "--out", out.string()}, SIGTERM, "record");
  EXPECT_EQ(result.exit_status, 1) << result.err;
  EXPECT_GE(Kept(result), 1) << result.err;
  EXPECT_EQ(FramesIn(out), Kept(result));
}

class InterruptedTrack : public testing::TestWithParam<const char*> {};

TEST_P(InterruptedTrack, WritesTheFramesTrackedSoFar) {
  const TemporaryFolder folder;
  WriteLongFolder(folder / "in");
  const auto out = folder / (std::string("x") + GetParam());
  const CommandResult result =
      Interrupted({"track", (folder / "in").string(), "--out", out.string(), "--method", "none"},
                  SIGINT, "tracking");
  EXPECT_EQ(result.exit_status, 1) << result.err;
  EXPECT_GE(Kept(result), 1) << result.err;
  EXPECT_EQ(SkeletonsIn(out), Kept(result));
}

INSTANTIATE_TEST_SUITE_P(KeptOutput, InterruptedTrack, testing::Values(".jsonl", ".csv", ".trc"),
                         [](const auto& info) { return std::string(info.param).substr(1); });

// Without people the extrinsics cannot be estimated. The message names the interruption, not
// --extrinsics.
TEST(KeptOutput, OfInterruptedCamerasWithoutPeopleIsReportedAsInterrupted) {
  const TemporaryFolder folder;
  WriteLongFolder(folder / "a");
  WriteLongFolder(folder / "b");
  const auto out = folder / "x.jsonl";
  RunningCommand command =
      test::StartOssa({"track", (folder / "a").string(), (folder / "b").string(), "--out",
                       out.string(), "--method", "none"});
  EXPECT_TRUE(command.WaitForError("tracking", test::kCommandTimeout));
  std::this_thread::sleep_for(std::chrono::seconds(1));  // for the first frames of both
  command.Signal(SIGINT);
  const CommandResult result = command.Wait(test::kCommandTimeout);
  EXPECT_EQ(result.exit_status, 1) << result.err;
  EXPECT_NE(result.err.find("interrupted"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(KeptOutput, OfAnInterruptedReconstructionHasAllFramesWrittenSoFar) {
  const TemporaryFolder folder;
  recon::WriteSkeletons(folder / "in.jsonl", recon::ExampleSequence(kMany));
  const auto out = folder / "x.jsonl";
  const CommandResult result =
      Interrupted({"reconstruct", (folder / "in.jsonl").string(), "--out", out.string()}, SIGINT,
                  "reconstruct");
  EXPECT_EQ(result.exit_status, 1) << result.err;
  EXPECT_GE(Kept(result), 1) << result.err;
  EXPECT_EQ(SkeletonsIn(out), Kept(result));
}

// `ulimit -f` counts kilobytes.
CommandResult OnAFullDisk(const std::vector<std::string>& arguments, int kilobytes = 4) {
  const std::string limited = "ulimit -f " + std::to_string(kilobytes) + R"(; exec "$@")";
  std::vector<std::string> argv = {"/bin/bash", "-c", limited, "shell", test::OssaPath()};
  argv.insert(argv.end(), arguments.begin(), arguments.end());
  return test::RunProgram(argv);
}

TEST(KeptOutput, OfTrackOnAFullDiskHasCompleteFrames) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 200);
  const auto out = folder / "x.jsonl";
  const CommandResult result = OnAFullDisk(
      {"track", folder.path().string(), "--out", out.string(), "--method", "none", "--quiet"});
  EXPECT_EQ(result.exit_status, 1);
  const std::string kept = std::to_string(SkeletonsIn(out));
  const std::string begin =
      "ossa: " + out.string() + ": writing failed: is the disk full? " + kept + " of ";
  EXPECT_TRUE(result.err.starts_with(begin)) << result.err << begin;
  EXPECT_EQ(test::LineCount(result.err), 1) << result.err;
}

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The trace of an empty frame is longer than its skeletons: it fills the disk first.
TEST(KeptOutput, OfTrackWhoseTraceFillsTheDiskHasTheOtherFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  depth::DepthFrame nothing = test::ExampleFrame(0, 64, 48);
  std::fill(nothing.depth_mm.begin(), nothing.depth_mm.end(), uint16_t{0});
  for (int i = 0; i < 100; ++i) {
    depth::WriteDepthPng(folder / ("in/" + std::to_string(i) + ".png"), nothing.view());
  }
  const auto out = folder / "x.jsonl", trace = folder / "trace.jsonl", stats = folder / "x.json";
  const CommandResult result =
      OnAFullDisk({"track", folder / "in", "--out", out, "--method", "none", "--quiet", "--trace",
                   trace, "--json-stats", stats});
  EXPECT_EQ(result.exit_status, 1);
  const std::string lines = TextOf(trace);
  EXPECT_GT(test::LineCount(lines), 3);
  EXPECT_TRUE(lines.ends_with("}\n"));
  const std::string says = "ossa: " + trace.string() + ": writing failed: is the disk full? " +
                           std::to_string(test::LineCount(lines)) + " of " +
                           std::to_string(SkeletonsIn(out)) + " frames";
  EXPECT_TRUE(result.err.starts_with(says)) << result.err << says;
  EXPECT_TRUE(std::filesystem::exists(stats));
}

TEST(KeptOutput, OfAFakenectDumpOnAFullDiskHasCompleteFrames) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  depth::WriteDepthPng(folder / "in/0.png", test::ExampleFrame(0, 640, 480).view());
  const auto dump = folder / "dump";
  const std::vector<std::string> record = {"record", folder / "in", "--fakenect", "--out", dump};
  EXPECT_EQ(OnAFullDisk(record, 100).exit_status, 1);
  EXPECT_FALSE(std::filesystem::exists(dump / "INDEX.txt")) << "a dump of no frame";
  EXPECT_EQ(test::RunOssa(record).exit_status, 0);
}

TEST(KeptOutput, OfReconstructOnAFullDiskHasCompleteFrames) {
  const TemporaryFolder folder;
  recon::WriteSkeletons(folder / "in.jsonl", recon::ExampleSequence(50));
  const auto out = folder / "x.csv";
  const CommandResult result = OnAFullDisk({"reconstruct", (folder / "in.jsonl").string(), "--out",
                                            out.string(), "--method", "one-euro", "--quiet"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find(std::to_string(SkeletonsIn(out)) + " of "), std::string::npos)
      << result.err;
}

// Only the picture is too large for the disk; the other outputs fit.
TEST(KeptOutput, OfTrackWhosePictureFillsTheDiskHasTheOtherFiles) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  test::WriteExampleFolder(folder / "in", 1, 320, 240);
  const auto out = folder / "x.jsonl", picture = folder / "x.png", stats = folder / "x.json";
  const CommandResult result =
      OnAFullDisk({"track", folder / "in", "--out", out, "--method", "none", "--quiet", "--picture",
                   picture, "--json-stats", stats});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find("x.png"), std::string::npos) << result.err;
  EXPECT_EQ(SkeletonsIn(out), 1);
  EXPECT_TRUE(std::filesystem::exists(stats));
}

TEST(KeptOutput, OfReconstructWhoseDynamicsFillTheDiskHasTheSkeletons) {
  const TemporaryFolder folder;
  recon::WriteSkeletons(folder / "in.jsonl", recon::ExampleSequence(50));
  const auto out = folder / "x.jsonl";
  const CommandResult result =
      OnAFullDisk({"reconstruct", folder / "in.jsonl", "--out", out, "--method", "one-euro",
                   "--physics", "on", "--dynamics", folder / "x.csv", "--quiet"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_GE(SkeletonsIn(out), 1) << result.err;
}

TEST(KeptOutput, OfCompareOnAFullDiskIsThePrintedTable) {
  const TemporaryFolder folder;
  const std::string skeletons = folder / "in.jsonl";
  recon::WriteSkeletons(skeletons, recon::ExampleSequence(50));
  const CommandResult result =
      OnAFullDisk({"compare", skeletons, skeletons, "--json", folder / "x.json"}, 0);
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.out.find("0.0"), std::string::npos) << result.err;
}

TEST(KeptOutput, OfAFolderWithAFrameOfAnotherSizeHasTheOtherFrames) {
  const TemporaryFolder folder;
  depth::WriteDepthPng(folder / "a.png", test::ExampleFrame(0, 64, 48).view());
  depth::WriteDepthPng(folder / "b.png", test::ExampleFrame(1, 32, 24).view());
  const auto out = folder / "x.jsonl";
  const CommandResult result =
      test::RunOssa({"track", folder.path().string(), "--out", out.string()});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("skipped 1 of 2 frames"), std::string::npos) << result.err;
  EXPECT_EQ(SkeletonsIn(out), 1);
}

TEST(KeptOutput, OfAKilledRecorderIsReadWithAWarning) {
  const TemporaryFolder folder;
  WriteLongFolder(folder / "in");
  const std::string out = (folder / "x.oni").string();
  EXPECT_EQ(Interrupted({"record", (folder / "in").string(), "--out", out}, SIGKILL, "record")
                .exit_status,
            128 + SIGKILL);
  std::filesystem::remove_all(folder / "in");
  const std::string left = std::filesystem::directory_iterator(folder.path())->path().string();
  EXPECT_EQ(left.rfind(out + ".partial-", 0), 0U) << left;
  const CommandResult saved = test::RunOssa({"record", left, "--out", out, "--quiet"});
  EXPECT_EQ(saved.exit_status, 0) << saved.err;
  EXPECT_NE(saved.err.find("the recording has no end"), std::string::npos) << saved.err;
  EXPECT_NE(saved.err.find("left by an ossa that was killed"), std::string::npos) << saved.err;
  EXPECT_GE(FramesIn(out), 1);
  EXPECT_TRUE(std::filesystem::exists(left)) << "it stays";
}

}  // namespace
}  // namespace ossa::commands
