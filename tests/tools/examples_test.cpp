// tools/examples: their output for a recording, and that they build with the sources of ossa as a
// subdirectory. tests/run also builds them against an installed ossa.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::test {
namespace {

struct HeadLine {
  double time_s = 0.0;
  int person = 0;
  double head_m[3] = {};
  std::string word;
};

std::vector<HeadLine> HeadsBy(const std::string& example) {
  const auto run =
      RunProgram({BinaryFolder() / "bin" / example, SourceFolder() / "tests/golden/clips/one"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  const std::regex line(
      R"(([0-9.]+) s: person (\d+) has the head at (-?[0-9.]+) (-?[0-9.]+) (-?[0-9.]+) m, (\w+))");
  std::vector<HeadLine> heads;
  std::istringstream out(run.out);
  for (std::string text; std::getline(out, text);) {
    std::smatch match;
    EXPECT_TRUE(std::regex_match(text, match, line)) << text;
    if (match.size() != 7) continue;
    heads.push_back({std::stod(match[1]),
                     std::stoi(match[2]),
                     {std::stod(match[3]), std::stod(match[4]), std::stod(match[5])},
                     match[6]});
  }
  return heads;
}

TEST(Examples, LiveTrackersInCppAndCPrintTheSameHeads) {
  const auto cpp = HeadsBy("live_tracker"), c = HeadsBy("live_tracker_c");
  ASSERT_GT(cpp.size(), 20U);
  ASSERT_EQ(cpp.size(), c.size());
  for (size_t i = 0; i < cpp.size(); ++i) {
    EXPECT_EQ(cpp[i].time_s, c[i].time_s);
    EXPECT_EQ(cpp[i].person, c[i].person);
    EXPECT_EQ(cpp[i].word, c[i].word);
    // Centimetres of a double and of a float may be rounded apart.
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(cpp[i].head_m[k], c[i].head_m[k], 0.0101);
    EXPECT_GT(cpp[i].head_m[2], 1.0) << "before the camera";
  }
}

// The ball's fall ends with its impulse on the table's top; a pull of 400 N breaks a grip of 150 N.
TEST(Examples, PhysicalWorldPrintsItsEvents) {
  const auto run = RunProgram({BinaryFolder() / "bin" / "physical_world"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("an object touches an object"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("the ball lies at 0.78 m"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("object 2 is torn off"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("the mace is 0.3"), std::string::npos) << run.out;
}

TEST(Examples, ReportErrorsInOneLine) {
  for (const char* example : {"live_tracker", "live_tracker_c"}) {
    const auto run = RunProgram({BinaryFolder() / "bin" / example, "/nowhere.oni"});
    EXPECT_EQ(run.exit_status, 1) << example;
    EXPECT_NE(run.err.find("/nowhere.oni"), std::string::npos) << run.err;
    EXPECT_EQ(LineCount(run.err), 1) << run.err;
  }
}

// FetchContent adds the sources by add_subdirectory, where CMAKE_SOURCE_DIR is the other project's.
// All is configured and one source of the example compiled.
TEST(Examples, BuildWithOssaAsASubdirectory) {
  const TemporaryFolder folder;
  const std::string build = folder / "build";
  const auto configured = RunProgram(
      {"/usr/bin/env", "cmake", "-G", "Ninja", "-S", SourceFolder() / "tools/examples", "-B", build,
       "-DOSSA_FETCH=ON", "-DFETCHCONTENT_SOURCE_DIR_OSSA=" + SourceFolder().string()});
  ASSERT_EQ(configured.exit_status, 0) << configured.err;
  const auto compiled = RunProgram({"/usr/bin/env", "cmake", "--build", build, "--target",
                                    "CMakeFiles/live_tracker.dir/live_tracker.cpp.o"});
  EXPECT_EQ(compiled.exit_status, 0) << compiled.out << compiled.err;
  EXPECT_FALSE(std::filesystem::exists(build + "/compile_commands.json")) << "not asked for";
  std::ifstream cache(build + "/CMakeCache.txt");
  for (std::string line; std::getline(cache, line);) {
    EXPECT_FALSE(line.starts_with("BUILD_SHARED_LIBS")) << "would be for their libraries: " << line;
  }
}

// A program that links static libraries of ossa also links their dependencies, which the package
// file must find. Configured, not built.
TEST(Examples, BuildAgainstAPackageOfStaticLibraries) {
  const TemporaryFolder folder;
  const std::string ossa = folder / "ossa", project = folder / "project";
  const auto configured =
      RunProgram({"/usr/bin/env", "cmake", "-G", "Ninja", "-S", SourceFolder(), "-B", ossa,
                  "-DBUILD_SHARED_LIBS=OFF", "-DOSSA_BUILD_TESTS=OFF", "-DOSSA_PYTHON=OFF"});
  ASSERT_EQ(configured.exit_status, 0) << configured.err;
  const auto looked = RunProgram(
      {"/usr/bin/env", "cmake", "-G", "Ninja", "-S", SourceFolder() / "tests/tools/static_package",
       "-B", project, "-DOSSA_BUILD=" + ossa, "-DOSSA_SOURCE=" + SourceFolder().string()});
  EXPECT_EQ(looked.exit_status, 0) << looked.err;
}

}  // namespace
}  // namespace ossa::test
