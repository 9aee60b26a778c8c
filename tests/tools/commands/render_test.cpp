// `ossa render` as a process: which options may be combined, and how the manifest records them.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/files/skeleton_io.h"
#include "recon/fuse/extrinsics.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tools/commands/shell_word.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

struct Refused {
  std::vector<std::string> words;
  std::string said;
};

TEST(RenderCommand, RefusesConflictingOptionsAsWrongUsage) {
  const test::TemporaryFolder folder;
  const std::vector<Refused> cases = {
      {{"--camera", "any"}, "--format packed"},
      {{"--camera", "any", "--format", "packed", "--fov", "60"}, "leave --fov"},
      {{"--camera", "any", "--format", "packed", "--sequence"}, "--sequence"},
      {{"--occluders", "desk", "--sequence"}, "--occluders desk"},
      {{"--poses", "any", "--sequence"}, "--poses any"},
      {{"--noise", "kinect-v3"}, "kinect-v2"},
      {{"--cameras", "2"}, "--cameras: expected --sequence"},
      {{"--cameras", "2", "--sequence", "--background", "lived-in"}, "--background lived-in"},
      {{"--shrink", "0.5"}, "--shrink"},
      {{"--size", "4294967936x480"}, "--size: expected WIDTHxHEIGHT"},
      {{"--size", "640x480x"}, "--size: expected WIDTHxHEIGHT"},
      {{"--size", "640"}, "--size: expected WIDTHxHEIGHT"},
      {{"--size", "4096x4096", "--shrink", "4"}, "--shrink 4: expected a sensor of at most 8192"},
      {{"--bodies", "average", "--clothes", "any"}, "--clothes any"}};
  for (const Refused& refused : cases) {
    std::vector<std::string> words = {"render", "--mocap", "authored",    "--frames",
                                      "1",      "--out",   folder / "set"};
    words.insert(words.end(), refused.words.begin(), refused.words.end());
    const auto run = RunOssa(words);
    EXPECT_EQ(run.exit_status, 2) << refused.said;
    EXPECT_NE(run.err.find(refused.said), std::string::npos) << run.err;
  }
}

TEST(RenderCommand, TakesSeveralFoldersAfterOneOptionOrEachAfterItsOwn) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--mocap", "authored", folder / "absent"},
        std::vector<std::string>{"--mocap", "authored", "--mocap", folder / "absent"}}) {
    std::vector<std::string> command = {"render", "--frames", "1", "--out", folder / "set"};
    command.insert(command.end(), words.begin(), words.end());
    const auto run = RunOssa(command);
    EXPECT_EQ(run.exit_status, 1);
    EXPECT_NE(run.err.find(folder / "absent"), std::string::npos) << run.err;
  }
}

TEST(RenderCommand, WritesTheCameraOfShrunkImagesToTheManifest) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const auto run = RunOssa({"render", "--mocap", "authored-floor", "--frames", "2", "--out",
                            folder / "set", "--size", "100x100", "--fov", "45.6", "--shrink", "2.4",
                            "--noise", "xtion", "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto manifest = nlohmann::json::parse(std::ifstream(folder / "set/manifest.json"));
  EXPECT_EQ(manifest["camera"]["width"], 100);
  // 50 / tan(22.8°); ITOP's, as its makers shrunk it, is 119.05.
  EXPECT_NEAR(manifest["camera"]["fx"].get<double>(), 118.9, 0.1);
  EXPECT_NE(manifest["command"].get<std::string>().find("--shrink 2.4"), std::string::npos);
}

// The command of a manifest can be pasted into a shell.
TEST(ShellWord, IsQuotedWhereAShellWouldSplitOrExpandIt) {
  EXPECT_EQ(ShellWord("mocap/cmu30_train"), "mocap/cmu30_train");
  EXPECT_EQ(ShellWord("Bewegungen/Größe"), "Bewegungen/Größe");
  EXPECT_EQ(ShellWord("my mocap"), "'my mocap'");
  EXPECT_EQ(ShellWord("it's $HOME"), "'it'\\''s $HOME'");
}

class RenderCameras : public testing::Test {
 protected:
  test::CommandResult Render() {
    return RunOssa({"render", "--mocap", "authored", "--frames", "3", "--out", out_, "--size",
                    "64x48", "--sequence", "--cameras", "2", "--quiet"});
  }
  test::TemporaryFolder folder_;
  std::string out_ = folder_ / "clip";
};

TEST_F(RenderCameras, WriteADataSetAndExtrinsicsEach) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  for (int again = 0; again < 2; ++again) {  // what is there stays
    const auto run = Render();
    ASSERT_EQ(run.exit_status, 0) << run.err;
    std::ofstream(out_ + "/extrinsics.json.partial-0123456789ab") << "killed while it wrote";
  }
  const auto cameras = recon::ReadExtrinsics(folder_ / "clip/extrinsics.json");
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_GT(cameras[1].from_camera_0.translation().norm(), 1.0);
  for (const auto& camera : cameras) {
    const std::filesystem::path set = folder_ / ("clip/" + camera.name);
    const auto manifest = nlohmann::json::parse(std::ifstream(set / "manifest.json"));
    EXPECT_NE(manifest["command"].get<std::string>().find("--cameras 2"), std::string::npos);
    EXPECT_EQ(recon::ReadSkeletons(set / "truth.jsonl").frames.size(), 3u);
    EXPECT_TRUE(std::filesystem::exists(set / "depth/000002.png"));
  }
}

TEST_F(RenderCameras, RefuseAFolderWithOtherFiles) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  std::filesystem::create_directories(out_);
  std::ofstream(out_ + "/manifest.json") << "{}";
  const auto run = Render();
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("expected an empty folder, found manifest.json"), std::string::npos)
      << run.err;
}

}  // namespace
}  // namespace ossa::commands
