// `ossa prior` from the outside: a prior that its reader takes, and wrong usage.
#include <gtest/gtest.h>

#include <filesystem>

#include "recon/gp/posture_prior.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

TEST(PriorCommand, LearnsAPriorOfTheModesAskedForThatInfoShows) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossaprior";
  const auto run = RunOssa({"prior", "--mocap", "authored", "--modes", "12", "--out", out});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_EQ(recon::PosturePrior::Load(out).time_s.size(), 12);
  const auto info = RunOssa({"info", out});
  EXPECT_EQ(info.exit_status, 0) << info.err;
  EXPECT_NE(info.out.find("posture prior, 12 modes learned from "), std::string::npos) << info.out;
}

TEST(PriorCommand, SaysWhatIsWrongInOneLine) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossaprior";
  EXPECT_EQ(RunOssa({"prior", "--out", out}).exit_status, 2);
  EXPECT_EQ(RunOssa({"prior", "--mocap", "authored", "--modes", "58", "--out", out}).exit_status,
            2);
  const auto run = RunOssa({"prior", "--mocap", "/nonexistent", "--out", out});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("/nonexistent"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace ossa::commands
