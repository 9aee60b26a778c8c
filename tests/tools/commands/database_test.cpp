// `ossa database` from the outside: a database that its reader takes, and wrong usage.
#include <gtest/gtest.h>

#include <filesystem>

#include "recon/database/posture_database.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using test::RunOssa;

TEST(DatabaseCommand, WritesADatabaseWithTheRequestedFilter) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossadb";
  const auto run = RunOssa({"database", "--mocap", "authored", "--out", out, "--threshold", "0.5",
                            "--filter", "sum-squared", "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto database = recon::PostureDatabase::Load(out);
  EXPECT_GT(database.size(), 20);
  EXPECT_EQ(database.options().filter, recon::DatabaseFilter::kSumSquared);
  EXPECT_EQ(database.options().threshold_m, 0.5);
}

TEST(DatabaseCommand, ReportsErrorsInOneLine) {
  const test::TemporaryFolder folder;
  const std::string out = folder / "x.ossadb";
  EXPECT_EQ(RunOssa({"database", "--out", out}).exit_status, 2);
  const auto fine =
      RunOssa({"database", "--mocap", "authored", "--out", out, "--threshold", "1e-50"});
  EXPECT_EQ(fine.exit_status, 2);
  EXPECT_NE(fine.err.find("--threshold"), std::string::npos) << fine.err;
  const auto run = RunOssa({"database", "--mocap", "/nonexistent", "--out", out, "--quiet"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("/nonexistent"), std::string::npos) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace
}  // namespace ossa::commands
