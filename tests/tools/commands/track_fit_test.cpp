// `ossa track` and the surface fit: fitted joints, the file of a person.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/commands/tracked_folders.h"

namespace ossa::commands {
namespace {

using test::CommandResult;
using test::LineCount;
using test::RunOssa;
using test::TemporaryFolder;
using tracker::ModelOrNothing;

TEST(TrackCommand, SavesAPersonFileAndReadsIt) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 6);
  const std::string source = (folder / "in").string(), me = (folder / "me.ossaperson").string();
  const CommandResult first = RunOssa({"track", source, "--save-person", me});
  ASSERT_EQ(first.exit_status, 0) << first.err;
  EXPECT_NE(first.out.find("person 1, "), std::string::npos) << first.out;
  const CommandResult again =
      RunOssa({"track", source, "--person", me, "--save-person", me, "--json-stats", "-"});
  ASSERT_EQ(again.exit_status, 0) << again.err;
  const CommandResult info = RunOssa({"info", me});
  EXPECT_NE(info.out.find("m tall"), std::string::npos) << info.out;
}

// A camera of the same image size with a third wider view: f of a D435 is 384 px, of a Kinect v1
// 575 px.
void WidenView(const std::filesystem::path& folder) {
  constexpr double kWider = 575.0 / 384.0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const auto image = depth::ReadDepthPng(entry.path());
    depth::DepthFrame frame;
    frame.camera = depth::KinectV1Camera(image.width, image.height);
    frame.depth_mm.assign(image.data.size(), 0);
    for (int v = 0; v < image.height; ++v) {
      for (int u = 0; u < image.width; ++u) {
        const auto from_u = static_cast<int>(std::lround((u - 0.5 * image.width) * kWider));
        const auto from_v = static_cast<int>(std::lround((v - 0.5 * image.height) * kWider));
        const int x = from_u + image.width / 2, y = from_v + image.height / 2;
        if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
        frame.depth_mm[static_cast<size_t>(v * image.width + u)] =
            image.data[static_cast<size_t>(y * image.width + x)];
      }
    }
    depth::WriteDepthPng(entry.path(), frame.view());
  }
}

TEST(TrackCommand, WarnsWhenAGuessedCameraMakesPeopleTooSmall) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 12);
  const auto told = [&](const std::vector<std::string>& more) {
    const CommandResult run = TrackTo(folder / "in", folder / "x.jsonl", more, "best");
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return run.err;
  };
  EXPECT_EQ(told({}).find("tall as"), std::string::npos) << "a Kinect's";
  WidenView(folder / "in");
  const std::string wide = told({});
  EXPECT_NE(wide.find("m tall as a kinect-v1 sees them"), std::string::npos) << wide;
  EXPECT_NE(wide.find("d435: 1."), std::string::npos) << wide;
  EXPECT_EQ(told({"--camera", "d435"}).find("tall as"), std::string::npos) << "said";
  EXPECT_EQ(told({"--quiet"}), "");
}

TEST(TrackCommand, RefusesAPersonFileThatIsDamaged) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 1);
  const std::string me = (folder / "me.ossaperson").string();
  std::ofstream(me) << "no person";
  const CommandResult result =
      RunOssa({"track", (folder / "in").string(), "--json-stats", "-", "--person", me});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find(me + ": "), std::string::npos) << result.err;
  EXPECT_EQ(LineCount(result.err), 1);
}

TEST(TrackCommand, ReportsThatNobodyCouldBeSaved) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "wall");
  WriteFlat(folder / "wall", 2000, 2);
  const std::string me = (folder / "me.ossaperson").string();
  const CommandResult result =
      RunOssa({"track", (folder / "wall").string(), "--save-person", me, "--quiet"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_NE(result.err.find(me + ": expected a person"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(me));
}

TEST(TrackCommand, WritesFittedJointsWithTheirStandardDeviations) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 6);
  const CommandResult result =
      TrackTo(folder / "in", folder / "fit.jsonl", {"--posture", "fitted", "--quiet"}, "best");
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const auto read = recon::ReadSkeletons(folder / "fit.jsonl");
  const auto& head = read.frames.back().bodies.at(0).joints[recon::Joint::kHead];
  ASSERT_TRUE(head && head->sigma_m);
  EXPECT_GT(head->sigma_m->minCoeff(), 0.0);
  EXPECT_LT(head->sigma_m->maxCoeff(), 0.2);
}

TEST(TrackCommand, WritesNoFittedJointsWithoutAFit) {
  const CommandResult result =
      RunOssa({"track", "in", "--out", "x.jsonl", "--fit", "off", "--posture", "fitted"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("--posture fitted: expected --fit on"), std::string::npos)
      << result.err;
}

TEST(TrackCommand, RefusesAPersonFileWithoutAFit) {
  const CommandResult result =
      RunOssa({"track", "in", "--out", "x.jsonl", "--fit", "off", "--person", "me.ossaperson"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("--person: expected a surface fit"), std::string::npos) << result.err;
}

TEST(TrackCommand, RefusesToSaveAPersonWithoutJointsForAFit) {
  for (const auto& without : {std::vector<std::string>{"--method", "none"},
                              std::vector<std::string>{"--refinement", "none"}}) {
    std::vector<std::string> words = {"track", "in", "--save-person", "me.ossaperson"};
    words.insert(words.end(), without.begin(), without.end());
    const CommandResult result = RunOssa(words);
    EXPECT_EQ(result.exit_status, 2);
    EXPECT_NE(result.err.find("--save-person: expected refined joints"), std::string::npos)
        << result.err;
    // Under the ceiling a body is fitted to the forest's joints.
    words.insert(words.end(), {"--mount", "ceiling"});
    EXPECT_EQ(RunOssa(words).exit_status, 1);  // there is no such recording
  }
}

}  // namespace
}  // namespace ossa::commands
