// Skeletons of other programs in every command that reads them: joint names by --mapping, warnings
// of oddities on stderr, unknown names refused.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "recon/files/skeleton_io.h"
#include "tests/recon/motion/figure.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa::commands {
namespace {

using recon::test::FigurePlaces;
using recon::test::kFigureSdkJoints;

/// The figure's joints as points in millimetres, M0, M1, ...
std::string FigureTrc(size_t frames) {
  const size_t points = std::size(kFigureSdkJoints);
  std::string text =
      "PathFileType\t4\t(X/Y/Z)\tx.trc\nDataRate\tNumFrames\tNumMarkers\tUnits\n30\t" +
      std::to_string(frames) + "\t" + std::to_string(points) + "\tmm\nFrame#\tTime";
  for (size_t p = 0; p < points; ++p) text += "\tM" + std::to_string(p) + "\t\t";
  text += "\n\t\tX1\tY1\tZ1\n\n";
  for (size_t f = 0; f < frames; ++f) {
    text += std::to_string(f + 1) + "\t" + std::to_string(0.0333333 * static_cast<double>(f));
    const auto places = FigurePlaces(f);
    for (const auto& [joint, number] : kFigureSdkJoints) {
      for (const double value : places[number]) text += "\t" + std::to_string(10.0 * value);
    }
    text += "\n";
  }
  return text;
}

class ForeignSkeletons : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "x.trc") << FigureTrc(30);
    std::ofstream(folder_ / "x.bvh") << recon::test::FigureBvh();
    std::ofstream mapping(folder_ / "names.txt");
    for (size_t p = 0; p < std::size(kFigureSdkJoints); ++p) {
      mapping << recon::kJointNames[static_cast<size_t>(kFigureSdkJoints[p].first)] << " = M" << p
              << "\n";
    }
  }
  test::TemporaryFolder folder_;
};

// A table with frame numbers only, and a TRC, which has times.
TEST_F(ForeignSkeletons, WithoutTimesUseTheGivenFrameRate) {
  std::ofstream(folder_ / "table.txt") << "0 Head 0 0.8 2\n0 HipCenter 0 0 2\n"
                                          "1 Head 0 0.8 2\n1 HipCenter 0 0 2\n";
  const auto read_at_50_hz = [&](const std::string& file) {
    const auto run =
        test::RunOssa({"reconstruct", folder_ / file, "--out", folder_ / "y.jsonl", "--method",
                       "none", "--fps", "50", "--mapping", folder_ / "names.txt"});
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return std::pair{recon::ReadSkeletons(folder_ / "y.jsonl").frames.at(1).time_s, run.err};
  };
  const auto [counted_s, said] = read_at_50_hz("table.txt");
  EXPECT_NEAR(counted_s, 0.02, 1e-6) << said;
  EXPECT_EQ(said.find("times of its own"), std::string::npos) << said;
  const auto [stated_s, warning] = read_at_50_hz("x.trc");
  EXPECT_NEAR(stated_s, 1.0 / 30.0, 1e-5);
  EXPECT_NE(warning.find("x.trc: its frames have times of its own"), std::string::npos) << warning;
}

TEST_F(ForeignSkeletons, FrameRateIsAnOptionOfEveryCommandThatReadsThem) {
  for (const char* command : {"compare", "reconstruct", "fuse", "learn", "view"}) {
    const auto run = test::RunOssa({command, "--help"});
    EXPECT_NE(run.out.find("--fps FLOAT"), std::string::npos) << command;
    EXPECT_EQ(test::RunOssa({command, "x", "--fps", "0"}).exit_status, 2) << command;
  }
}

TEST_F(ForeignSkeletons, WithoutKnownJointNamesAreRefusedWithAListOfTheirNames) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"compare", folder_ / "x.bvh", folder_ / "x.trc"},
        {"reconstruct", folder_ / "x.trc", "--out", folder_ / "y.jsonl"},
        {"learn", "--observed", folder_ / "x.trc", "--truth", folder_ / "x.bvh", "--out",
         folder_ / "y.ossagp"},
        {"info", folder_ / "x.trc"}}) {
    const auto run = test::RunOssa(words);
    EXPECT_EQ(run.exit_status, 1) << words[0];
    EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
    EXPECT_NE(run.err.find("found 'M0', 'M1'"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--mapping"), std::string::npos) << run.err;
  }
  EXPECT_FALSE(std::filesystem::exists(folder_ / "y.jsonl"));
}

// 5 cm when a BVH was retargeted to the standard body.
TEST_F(ForeignSkeletons, OfOneMotionInTwoFormatsAreEqual) {
  const auto run = test::RunOssa({"compare", folder_ / "x.bvh", folder_ / "x.trc", "--mapping",
                                  folder_ / "names.txt", "--json", "-"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out)["results"][0];
  EXPECT_EQ(result["frames"], 30);
  EXPECT_LT(result["mean_joint_error_cm"].get<double>(), 1e-4);
}

TEST_F(ForeignSkeletons, KeepTheirPlaceWhenReconstructed) {
  const auto run =
      test::RunOssa({"reconstruct", folder_ / "x.trc", "--mapping", folder_ / "names.txt",
                     "--method", "none", "--out", folder_ / "y.jsonl", "--quiet"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto made = recon::ReadSkeletons(folder_ / "y.jsonl");
  const auto places = FigurePlaces(12);
  for (const auto& [joint, number] : kFigureSdkJoints) {
    const auto& at = made.frames.at(12).bodies.at(0).joints[static_cast<size_t>(joint)];
    EXPECT_LT((at.value().position_m - 0.01 * places[number]).norm(), 1e-5);
  }
}

TEST_F(ForeignSkeletons, AreReadByLearn) {
  const auto run = test::RunOssa({"learn", "--observed", folder_ / "x.trc", "--truth",
                                  folder_ / "x.bvh", "--mapping", folder_ / "names.txt", "--out",
                                  folder_ / "y.ossagp", "--correction-only", "--quiet"});
  EXPECT_EQ(run.exit_status, 0) << run.err;
}

// The learned file would be empty.
TEST_F(ForeignSkeletons, WithTooFewFramesAreRefusedByLearn) {
  std::ofstream(folder_ / "x.trc") << FigureTrc(5);
  const auto run =
      test::RunOssa({"learn", "--observed", folder_ / "x.trc", "--truth", folder_ / "x.bvh",
                     "--mapping", folder_ / "names.txt", "--out", folder_ / "y.ossagp", "--quiet"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("x.trc: expected 10 frames or more"), std::string::npos) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "y.ossagp"));
}

TEST_F(ForeignSkeletons, WithOddContentAreReadWithAWarning) {
  std::string text = recon::test::FigureBvh();
  text.replace(text.find("Frames: 30"), 10, "Frames: 75");
  std::ofstream(folder_ / "x.bvh") << text;
  const auto run = test::RunOssa({"compare", folder_ / "x.bvh", folder_ / "x.bvh", "--quiet"});
  EXPECT_EQ(run.exit_status, 0);
  EXPECT_NE(run.err.find("compare: warning: "), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("the header says 75 frames, the file has 30"), std::string::npos);
}

TEST_F(ForeignSkeletons, BadMappingLineIsReportedWithItsNumber) {
  std::ofstream(folder_ / "names.txt", std::ios::app) << "Spine = M99\n";
  const auto run = test::RunOssa(
      {"compare", folder_ / "x.bvh", folder_ / "x.trc", "--mapping", folder_ / "names.txt"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("names.txt: line 18: expected a point of"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace ossa::commands
