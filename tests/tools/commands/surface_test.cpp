// `ossa surface` as a process: interruption and --quiet.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "recon/body/body_model.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

class SurfaceCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  }

  test::TemporaryFolder folder_;
};

// Ctrl-C was ignored and the file was written.
TEST_F(SurfaceCommand, InterruptedWritesNothing) {
  const std::string out = folder_ / "x.ossasurface";
  test::RunningCommand run =
      test::StartOssa({"surface", "--mocap", "authored", "--people", "5000", "--out", out});
  ASSERT_TRUE(run.WaitForError("dressing people: 1 of 5000", test::kCommandTimeout));
  run.Signal(SIGINT);
  const test::CommandResult end = run.Wait(test::kCommandTimeout);
  EXPECT_EQ(end.exit_status, 1);
  EXPECT_NE(end.err.find("surface: interrupted; nothing was written"), std::string::npos)
      << end.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(SurfaceCommand, QuietPrintsNoProgress) {
  const test::CommandResult run =
      test::RunOssa({"surface", "--mocap", "authored", "--people", "50", "--points", "50", "--out",
                     folder_ / "x.ossasurface", "--quiet"});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_EQ(run.err, "");
}

}  // namespace
}  // namespace ossa::commands
