// `ossa info` recognises every kind of file by its content and refuses the rest in one line.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "recon/database/posture_database.h"
#include "recon/fit/body_mesh.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using test::CommandResult;
using test::LineCount;
using test::RunOssa;
using test::TemporaryFolder;

void ExpectShown(const std::filesystem::path& path, const std::string& what) {
  const CommandResult result = RunOssa({"info", path.string()});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.out.find(what), std::string::npos) << result.out;
}

void ExpectRefused(const std::filesystem::path& path, const std::string& why) {
  const CommandResult result = RunOssa({"info", path.string()});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find(path.string()), std::string::npos) << result.err;
  EXPECT_NE(result.err.find(why), std::string::npos) << result.err;
}

TEST(InfoCommand, ShowsTheCameraOfADevice) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 3, 320, 240);
  const std::string device = "openni:ossa://" + folder.path().string();
  ExpectShown(device, "depth camera, 320 x 240, fx 28");
  ExpectRefused("openni:ossa:///nowhere", "openni:ossa:///nowhere");
  const CommandResult result = RunOssa({"info", device, "--picture", folder / "x.png"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("expected a recording, found a device"), std::string::npos);
}

// A custom body surface: `info` shows its mesh, and written people use that mesh.
TEST(InfoCommand, ShowsTheSkinOfACustomBodySurface) {
  const TemporaryFolder folder;
  const auto shipped = test::SourceFolder() / "tools/tracker/shipped";
  recon::BodySurface surface = recon::BodySurface::Load(shipped / recon::kShippedSurface);
  recon::BodyMesh mesh = recon::BodyMesh::Load(shipped / recon::kShippedMesh, surface);
  surface.joint[3].mean_m.x() += 0.01;
  mesh.surface = surface;
  const std::string own = folder / "own.ossasurface", skin = folder / "own.ossamesh";
  surface.Save(own);
  mesh.Save(skin);
  EXPECT_EQ(RunOssa({"info", skin}).exit_status, 1);
  EXPECT_EQ(RunOssa({"info", skin, "--surface", own}).exit_status, 0);
  const std::string skeletons = folder / "x.jsonl", out = folder / "x.glb";
  std::ofstream(skeletons) << R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":)"
                           << R"({"Head":{"p":[0,0.5,2]},"HipCenter":{"p":[0,0,2]}}}]})"
                           << "\n";
  const std::vector<std::string> reconstruct = {"reconstruct", skeletons,  "--out",     out,
                                                "--method",    "one-euro", "--surface", own};
  EXPECT_EQ(RunOssa(reconstruct).exit_status, 2) << "without a skin";
  std::vector<std::string> with_skin = reconstruct;
  with_skin.insert(with_skin.end(), {"--mesh", skin});
  const CommandResult result = RunOssa(with_skin);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const CommandResult track =
      RunOssa({"track", folder.path(), "--out", out, "--surface", own, "--quiet"});
  EXPECT_EQ(track.exit_status, 2);
  EXPECT_NE(track.err.find("expected its skin with it, --mesh FILE.ossamesh"), std::string::npos)
      << track.err;
}

TEST(InfoCommand, NamesTheFolderOfDepthImagesInsideOne) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "depth");
  test::WriteExampleFolder(folder / "depth", 1);
  std::ofstream(folder / "camera.json") << "{}";
  ExpectRefused(folder.path(), "found none in it, but in " + std::string(folder / "depth"));
}

// Two postures that differ by far more than the filter's threshold.
recon::PostureDatabase TwoPostures() {
  recon::PostureClip clip{"two.bvh", {}, {}};
  for (const double bend_m : {0.0, 0.5}) {
    recon::Posture posture;
    for (size_t j = 1; j < recon::kJointCount; ++j) {
      const double up_m = 0.1 * static_cast<double>(j);
      posture.position_m[j] = {0.01 * static_cast<double>(j % 3) + bend_m * up_m, up_m, 0.0};
    }
    clip.postures.push_back(posture);
  }
  return recon::PostureDatabase::Build({clip}, {});
}

TEST(Ossa, PrintsItsVersionAndRefusesUnknownCommands) {
  const CommandResult version = RunOssa({"--version"});
  EXPECT_EQ(version.exit_status, 0);
  EXPECT_TRUE(version.out.starts_with("ossa ")) << version.out;
  const CommandResult unknown = RunOssa({"jump"});
  EXPECT_EQ(unknown.exit_status, 2);
  EXPECT_NE(unknown.err.find("unknown command 'jump'"), std::string::npos) << unknown.err;
}

TEST(InfoCommand, ShowsTheContentOfAPostureDatabase) {
  const TemporaryFolder folder;
  TwoPostures().Save(folder / "x.ossadb");
  ExpectShown(folder / "x.ossadb", "postures of 2 in 1 clips");
  ExpectShown(folder / "x.ossadb", "clip: two.bvh");
}

TEST(InfoCommand, ShowsTheContentOfTheShippedPrior) {
  ExpectShown(test::SourceFolder() / "tools/tracker/shipped/posture.ossaprior",
              "posture prior, 40 modes learned from ");
}

TEST(InfoCommand, ShowsTheContentOfAFolderOfDepthImages) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 3);
  ExpectShown(folder.path(), "depth images, 3 frames of ");
}

TEST(InfoCommand, AppliesSourceOptionsToDepthImages) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 3, 160, 120);
  const auto show = [&](const std::vector<std::string>& options) {
    std::vector<std::string> command = {"info", folder.path().string()};
    command.insert(command.end(), options.begin(), options.end());
    return RunOssa(command).out;
  };
  EXPECT_NE(show({"--fps", "10"}).find(", 0.20 s, "), std::string::npos);
  EXPECT_NE(show({"--camera", "100,101,80,60"}).find("fx 100.00 fy 101.00"), std::string::npos);
  EXPECT_NE(show({"--depth-scale", "2000"}).find("3 frames"), std::string::npos);
  EXPECT_NE(show({"--rotate", "auto"}).find("rotated by 0 degrees"), std::string::npos);
  EXPECT_EQ(RunOssa({"info", folder.path().string(), "--depth-scale", "0"}).exit_status, 2);
}

TEST(InfoCommand, ShowsTheRequestedDepthTopicOfABag) {
  const TemporaryFolder folder;
  ExpectRefused(folder / "none.bag#/depth", "no such file");
  std::ofstream(folder / "x.bag") << "#ROSBAG V2.0\nthen nothing";
  ExpectRefused(folder.path().string() + "/x.bag#/depth", "#/depth: ");
}

TEST(InfoCommand, ShowsTheContentOfASkeletonFile) {
  const TemporaryFolder folder;
  std::ofstream(folder / "x.jsonl")
      << R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":{"Head":{"p":[0,0,2]}}}]})"
      << "\n";
  ExpectShown(folder / "x.jsonl", "skeletons, 1 frames, 0.00 s, 1 bodies");
  ExpectShown(folder / "x.jsonl#truth", "skeletons, 1 frames, 0.00 s, 1 bodies");
  ExpectShown(folder.path(), "skeletons x, 1 frames, 0.00 s, 1 bodies");
}

TEST(InfoCommand, ShowsBothSkeletonsOfAPairedFile) {
  const TemporaryFolder folder;
  const std::string file = folder / "two.csv";
  std::ofstream(file) << "t_s,K_head_x,K_head_y,K_head_z,G_head_x,G_head_y,G_head_z\n"
                         "0.0,1,2,-240,1,2,-241\n0.5,1,2,-240,1,2,-241\n";
  const std::string rest = ", 2 frames, 0.50 s, 2 bodies\n";
  const std::string observed = "skeletons #observed" + rest, truth = "skeletons #truth" + rest;
  EXPECT_EQ(RunOssa({"info", file}).out, observed + truth);
  EXPECT_EQ(RunOssa({"info", file + "#observed"}).out, observed);
  EXPECT_EQ(RunOssa({"info", file + "#kinect"}).out, observed);
  EXPECT_EQ(RunOssa({"info", file + "#truth"}).out, truth);
  std::ofstream(folder / "one.jsonl")
      << R"({"frame":0,"time_s":0,"bodies":[{"id":1,"joints":{"Head":{"p":[0,0,2]}}}]})"
      << "\n";
  EXPECT_EQ(RunOssa({"info", folder.path().string()}).out,
            "skeletons one, 1 frames, 0.00 s, 1 bodies\nskeletons two#observed" + rest +
                "skeletons two#truth" + rest);
}

TEST(InfoCommand, RefusesDeeplyNestedJsonByItsFileName) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 1);
  std::filesystem::create_directory(folder / "depth");
  std::ofstream(folder / "truth.jsonl");
  std::ofstream(folder / "manifest.json") << "{\"command\":" + std::string(100'000, '[');
  ExpectRefused(folder.path(), "manifest.json: expected JSON that nests at most 32 deep");
  std::filesystem::remove(folder / "manifest.json");
  std::filesystem::remove(folder / "truth.jsonl");
  std::ofstream(folder / "camera.json") << std::string(100'000, '{');
  ExpectRefused(folder.path(), "camera.json: expected JSON that nests at most 32 deep");
}

TEST(InfoCommand, RefusesDamagedUnknownAndMissingFiles) {
  const TemporaryFolder folder;
  TwoPostures().Save(folder / "cut.ossadb");
  std::filesystem::resize_file(folder / "cut.ossadb", 100);
  ExpectRefused(folder / "cut.ossadb", "expected");
  std::ofstream(folder / "letter.txt") << "Dear Sir or Madam,\n";
  ExpectRefused(folder / "letter.txt", "expected");
  ExpectRefused(folder / "none.ossa", "no such file");
  std::ofstream(folder / "empty.ossa");
  ExpectRefused(folder / "empty.ossa", "forest model");
  std::filesystem::create_directory(folder / "empty");
  ExpectRefused(folder / "empty", "expected a DATASET, a folder of PNGs or one of skeleton files");
}

std::string Bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Width and height of a PNG: big-endian, after its signature and the name of the header chunk.
std::pair<int, int> SizeOfPng(const std::string& png) {
  const auto number = [&](size_t at) {
    int value = 0;
    for (size_t i = at; i < at + 4; ++i) value = 256 * value + static_cast<uint8_t>(png.at(i));
    return value;
  };
  return {number(16), number(20)};
}

TEST(InfoPicture, OfDepthImagesIsAContactSheetOfTwelve) {
  const TemporaryFolder folder;
  test::WriteExampleFolder(folder.path(), 30);
  const auto sheet = folder / "sheet.png";
  const std::string few = (test::SourceFolder() / "tests/golden/clips/one").string();
  ASSERT_EQ(RunOssa({"info", folder.path().string(), "--picture", sheet.string()}).exit_status, 0);
  EXPECT_EQ(SizeOfPng(Bytes(sheet)), std::pair(4 * 240, 3 * 180));
  ASSERT_EQ(RunOssa({"info", few, "--picture", sheet.string()}).exit_status, 0);
  EXPECT_EQ(SizeOfPng(Bytes(sheet)), std::pair(4 * 240, 3 * 180));
}

TEST(InfoPicture, OfAModelIsItsModelCard) {
  const TemporaryFolder folder;
  const std::string model = (test::SourceFolder() / "tools/tracker/shipped/body.ossa").string();
  const auto card = folder / "card.html";
  ASSERT_EQ(RunOssa({"info", model, "--picture", card.string()}).exit_status, 0);
  EXPECT_NE(Bytes(card).find("<title>Head front: 97.31</title>"), std::string::npos);
}

TEST(InfoCommand, ShowsWhatAModelHasLearnedBesidesItsTrees) {
  const std::string model = (test::SourceFolder() / "tools/tracker/shipped/body.ossa").string();
  EXPECT_NE(
      RunOssa({"info", model})
          .out.find("pose priors of 24 factors, a second stage of 512 units, joint-conditioned "
                    "relabelling\n"),
      std::string::npos);
}

TEST(InfoPicture, OfAnythingElseIsRefused) {
  const TemporaryFolder folder;
  std::ofstream(folder / "me.jsonl") << R"({"frame":0,"time_s":0,"bodies":[]})";
  const std::string file = (folder / "me.jsonl").string(), clip = folder.path().string();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"info", file, "--picture", (folder / "x.png").string()},
        {"info", clip, "--picture", (folder / "x.jpg").string()}}) {
    const CommandResult result = RunOssa(words);
    EXPECT_EQ(result.exit_status, 2) << result.err;
    EXPECT_EQ(LineCount(result.err), 1) << result.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "x.png"));
}

}  // namespace
}  // namespace ossa::commands
