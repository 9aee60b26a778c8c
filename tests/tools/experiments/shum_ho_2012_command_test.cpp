// `ossa experiment shum-ho-2012` as a process: one quick scene, and invalid parameters.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

using test::RunOssa;

std::string Content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class ShumHo2012Command : public testing::Test {
 protected:
  test::CommandResult Run(const std::string& toml, const std::string& out = "out",
                          const std::string& seed = "1") const {
    const std::string parameters = folder_ / "parameters.toml";
    std::ofstream(parameters) << toml;
    return RunOssa({"experiment", "shum-ho-2012", "--out", folder_ / out, "--parameters",
                    parameters, "--seed", seed, "--quiet"});
  }
  /// Every criterion of the one table is met.
  void ExpectAllAsWanted(const std::string& out) const {
    const auto summary = nlohmann::json::parse(Content(folder_ / (out + "/summary.json")));
    ASSERT_EQ(summary["tables"].size(), 1u);
    for (const auto& row : summary["tables"][0]["rows"]) EXPECT_EQ(row.back(), "yes") << row;
  }
  test::TemporaryFolder folder_;
};

TEST_F(ShumHo2012Command, CarriesABoxWithTheSameBytesTwice) {
  const auto run = Run("parts = [\"carry\"]\n");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  ExpectAllAsWanted("out");
  // The animation is an animated PNG whose chunks are complete.
  const std::string animation = Content(folder_ / "out/carry_animated.png");
  EXPECT_EQ(animation.substr(1, 3), "PNG");
  EXPECT_NE(animation.find("acTL"), std::string::npos);
  EXPECT_EQ(animation.substr(animation.size() - 8, 4), "IEND");
  EXPECT_LT(animation.size(), 3u << 20);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/carry.png"));

  ASSERT_EQ(Run("parts = [\"carry\"]\n", "again").exit_status, 0);
  EXPECT_EQ(animation, Content(folder_ / "again/carry_animated.png"));
}

TEST_F(ShumHo2012Command, AnotherMoverCarriesTheBoxAsWell) {
  const auto run = Run("parts = [\"carry\"]\n", "out", "2");
  ASSERT_EQ(run.exit_status, 0) << run.err;
  ExpectAllAsWanted("out");
}

TEST_F(ShumHo2012Command, RefusesAnUnknownPart) {
  const auto run = Run("parts = [\"juggling\"]\n");
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("juggling"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("carry"), std::string::npos) << run.err;  // what it could have been
}

TEST_F(ShumHo2012Command, RefusesAMisspeltParameter) {
  const auto run = Run("parts = []\nendurance = 3\n");
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find("endurance"), std::string::npos) << run.err;
}

TEST_F(ShumHo2012Command, RefusesAFolderThatIsAFile) {
  std::ofstream(folder_ / "out") << "in the way";
  const auto run = Run("parts = []\n");
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
}

}  // namespace
}  // namespace ossa
