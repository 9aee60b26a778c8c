// `ossa track` and the surface fit: fitted joints, the file of a person.
#include <gtest/gtest.h>

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

TEST(TrackCommand, SavesThePersonAndTakesThemAgain) {
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

TEST(TrackCommand, SaysWhereNobodyIsThereWhoCouldBeSaved) {
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

TEST(TrackCommand, TakesNoPersonFileWithoutAFit) {
  const CommandResult result =
      RunOssa({"track", "in", "--out", "x.jsonl", "--fit", "off", "--person", "me.ossaperson"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("--person: expected a surface fit"), std::string::npos) << result.err;
}

TEST(TrackCommand, SavesNobodyWithoutJointsThatABodyIsFittedTo) {
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
