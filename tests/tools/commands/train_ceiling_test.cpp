#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::tests {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;

// tools/train_ceiling with a stand-in for the command that logs its arguments and fails to refine
// while a file `cut_off` exists. Its model cards differ in every run, like those with times.
class TrainCeiling : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "mocap");
    for (const char* clip : {"01_01.bvh", "02_01.bvh", "03_01.bvh"}) {
      std::ofstream(folder_ / "mocap" / clip) << "BVH";
    }
    std::ofstream(folder_ / "ossa") << R"(#!/bin/sh
command=$1 model=$2
echo "$command"
[ "$command" = evaluate ] && echo $$ >>"$model"
[ "$command" = refine ] && [ -e "${0%ossa}cut_off" ] && exit 1
while [ $# -gt 1 ] && [ "$1" != --out ]; do shift; done
case $command in train | refine) echo learned >"$2" ;; esac
)";
    fs::permissions(folder_ / "ossa", fs::perms::owner_all);
  }
  CommandResult Run() const {
    return test::RunProgram({test::SourceFolder() / "tools/train_ceiling", folder_ / "mocap",
                             folder_ / "work", folder_ / "ossa"});
  }

  test::TemporaryFolder folder_;
};

// The script trained the forest again, and refused the stages of the cascade as another forest's.
TEST_F(TrainCeiling, ResumesInTheCascadeAfterAnInterruption) {
  std::ofstream(folder_ / "cut_off") << "yes";
  EXPECT_NE(Run().exit_status, 0);
  fs::remove(folder_ / "cut_off");
  const CommandResult again = Run();
  EXPECT_EQ(again.exit_status, 0) << again.err;
  EXPECT_EQ(again.out.find("train\n"), std::string::npos) << again.out;
  EXPECT_TRUE(fs::exists(folder_ / "work" / "body_ceiling.ossarefine"));
}

}  // namespace
}  // namespace ossa::tests
