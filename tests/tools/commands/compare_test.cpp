#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "recon/files/skeleton_io.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"

namespace ossa {
namespace {

using recon::ExampleSequence;
using test::RunOssa;

recon::SkeletonSequence Moved(recon::SkeletonSequence sequence, double by_m) {
  for (auto& frame : sequence.frames) {
    for (auto& body : frame.bodies) {
      for (auto& joint : body.joints) {
        if (joint) joint->position_m.y() += by_m;
      }
    }
  }
  return sequence;
}

std::string Content(const std::filesystem::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

class CompareCommand : public testing::Test {
 protected:
  CompareCommand() {
    recon::WriteSkeletons(truth_, ExampleSequence(20));
    recon::WriteSkeletons(near_, Moved(ExampleSequence(20), 0.02));
    recon::WriteSkeletons(far_, Moved(ExampleSequence(20), 0.25));
  }
  test::TemporaryFolder folder_;
  std::string truth_ = folder_ / "truth.jsonl";
  std::string near_ = folder_ / "near.trc";
  std::string far_ = folder_ / "far.csv";
};

TEST_F(CompareCommand, PrintsTablesAndWritesTheDocumentedJson) {
  const std::string json_path = folder_ / "out.json";
  const auto run = RunOssa({"compare", truth_, near_, far_, "--json", json_path});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("near.trc"), std::string::npos);
  const auto json = nlohmann::json::parse(Content(json_path));
  ASSERT_EQ(json["results"].size(), 2u);
  const auto& far = json["results"][1];
  EXPECT_EQ(far.at("frames"), 20);
  EXPECT_NEAR(far.at("mean_joint_error_cm"), 25.0, 1e-3);
  EXPECT_NEAR(far.at("parent_relative_error_cm"), 0.0, 1e-3);
  EXPECT_EQ(far.at("fraction_frames_over_20cm"), 0.0);
  EXPECT_EQ(far.at("fraction_joints_within_10cm"), 0.0);
  EXPECT_NEAR(far.at("acceleration_error_cm_per_frame2"), 0.0, 1e-3);
  EXPECT_NEAR(far.at("per_joint_cm").at("HandRight"), 25.0, 1e-3);
}

TEST_F(CompareCommand, WritesASelfContainedReport) {
  const std::string report = folder_ / "r.html";
  ASSERT_EQ(RunOssa({"compare", truth_, near_, "--report", report}).exit_status, 0);
  const std::string html = Content(report);
  EXPECT_NE(html.find("<svg"), std::string::npos);
  EXPECT_NE(html.find("Worst frames"), std::string::npos);
  EXPECT_TRUE(html.ends_with("</html>\n"));
  for (const char* outside : {"http://", "https://", "<script", "src="}) {
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  }
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST_F(CompareCommand, PrintsThePathOfTheReportAndSuggestsAlignmentWhenOriginsDiffer) {
  const std::string report = folder_ / "r.html";
  const std::string moved = folder_ / "moved.jsonl";
  recon::WriteSkeletons(moved, Moved(ExampleSequence(20), 3.0));
  auto run = RunOssa({"compare", truth_, moved, "--report", report});
  EXPECT_NE(run.out.find("3.0 m away from the truth"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("--align rigid"), std::string::npos);
  EXPECT_NE(run.out.find("Report: " + report), std::string::npos);
  run = RunOssa({"compare", truth_, near_});
  EXPECT_EQ(run.out.find("--align rigid"), std::string::npos) << run.out;
}

// The skeletons that mirrored depth images give.
recon::SkeletonSequence Mirrored(recon::SkeletonSequence sequence) {
  for (auto& frame : sequence.frames) {
    for (auto& body : frame.bodies) {
      const auto joints = body.joints;
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        body.joints[j] = joints[recon::kMirroredJoint[j]];
        if (body.joints[j]) body.joints[j]->position_m.x() *= -1;
      }
    }
  }
  return sequence;
}

TEST_F(CompareCommand, WarnsWhenAResultIsMirrored) {
  const std::string mirrored = folder_ / "mirrored.jsonl";
  recon::WriteSkeletons(mirrored, Mirrored(ExampleSequence(20)));
  auto run = RunOssa({"compare", truth_, mirrored});
  EXPECT_NE(run.out.find("mirrored.jsonl is far nearer to the truth as a mirror shows it"),
            std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("--mirrored"), std::string::npos) << run.out;
  run = RunOssa({"compare", truth_, near_, far_});
  EXPECT_EQ(run.out.find("--mirrored"), std::string::npos) << run.out;
}

// A moving person from `begin_s` of the motion on, in a file whose times begin at 0.
recon::SkeletonSequence SwingingFrom(double begin_s, int frames = 300) {
  recon::SkeletonSequence sequence;
  for (int f = 0; f < frames; ++f) {
    recon::SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = f;
    frame.time_s = f / 30.0;
    const auto posture = recon::test::InFrontOfCamera(recon::test::Motion(begin_s + frame.time_s));
    recon::BodyRecord& body = frame.bodies.emplace_back();
    body.id = 1;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.joints[j].emplace().position_m = posture.position_m[j];
    }
  }
  return sequence;
}

// In half a minute of movement a single frame shows.
TEST_F(CompareCommand, StatesALagOfAFrameWithItsStandardError) {
  const std::string truth = folder_ / "long.jsonl", late = folder_ / "lagging.jsonl";
  recon::WriteSkeletons(truth, SwingingFrom(0.0, 900));
  recon::WriteSkeletons(late, SwingingFrom(-1.0 / 30.0, 900));
  auto run = RunOssa({"compare", truth, late});
  EXPECT_NE(
      run.out.find("lagging.jsonl is 0.033 s behind the truth, 1.0 frames (standard error 0."),
      std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("add --time -0.033."), std::string::npos) << run.out;
  run = RunOssa({"compare", truth, late, "--time", "-0.033"});
  EXPECT_EQ(run.out.find("behind the truth"), std::string::npos) << run.out;
  run = RunOssa({"compare", truth, truth});
  EXPECT_EQ(run.out.find("the truth, "), std::string::npos) << run.out;
}

TEST_F(CompareCommand, NamesTheOffsetOfAResultThatBeganLaterWithTheSameFrameTimes) {
  const std::string first = folder_ / "first.jsonl", late = folder_ / "late.jsonl";
  recon::WriteSkeletons(first, SwingingFrom(0.0));
  recon::WriteSkeletons(late, SwingingFrom(0.8));
  auto run = RunOssa({"compare", first, late});
  EXPECT_NE(run.out.find("late.jsonl is far nearer to the truth with +0.80 s added to its times"),
            std::string::npos)
      << run.out;
  run = RunOssa({"compare", first, late, "--time", "correlate"});
  EXPECT_EQ(run.out.find("added to its times"), std::string::npos) << run.out;
}

// Arms that swing in opposite phase: half a period later they are their mirror image, nearly.
recon::SkeletonSequence WalkingFrom(double begin_s) {
  recon::SkeletonSequence sequence = SwingingFrom(0.0);
  for (auto& frame : sequence.frames) {
    const double t_s = begin_s + frame.time_s;
    const double swing_rad = 0.8 * std::sin(4.0 * t_s + 0.3 * std::sin(t_s));
    const auto posture =
        recon::test::InFrontOfCamera(recon::test::Gesture(0.9 + swing_rad, 0.9 - swing_rad, 0.3));
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      frame.bodies[0].joints[j]->position_m = posture.position_m[j];
    }
  }
  return sequence;
}

TEST_F(CompareCommand, NamesTheClockWhereAMirrorIsNearButTheClockIsNearer) {
  const std::string first = folder_ / "first.jsonl", late = folder_ / "late.jsonl";
  recon::WriteSkeletons(first, WalkingFrom(0.0));
  recon::WriteSkeletons(late, WalkingFrom(0.8));
  const auto run = RunOssa({"compare", first, late});
  EXPECT_NE(run.out.find("+0.80 s added to its times"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("--mirrored"), std::string::npos) << run.out;
}

TEST_F(CompareCommand, ReadsTruthAndEstimateFromOneFileThatHoldsBoth) {
  const std::string both = folder_ / "both.csv";
  // UI-PRMD's columns: Kinect and Vicon, centimetres; the wrists are 5 cm apart.
  std::ofstream file(both);
  file << "t_s,K_Waist_SpineBase_x,K_Waist_SpineBase_y,K_Waist_SpineBase_z,"
          "K_LHand_LWrist_x,K_LHand_LWrist_y,K_LHand_LWrist_z,G_head_x,G_head_y,G_head_z,"
          "G_Lwri_x,G_Lwri_y,G_Lwri_z\n";
  for (int f = 0; f < 3; ++f) {
    file << 0.033 * f << ",0,80,-240,0," << 100 + f << ",-240,,,,3," << 104 + f << ",-240\n";
  }
  file.close();
  const auto run = RunOssa({"compare", both, both, "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NEAR(nlohmann::json::parse(run.out)["results"][0]["mean_joint_error_cm"], 5.0, 1e-3);
}

TEST_F(CompareCommand, ComparesFoldersClipByClipWithIntervalsAndTests) {
  std::filesystem::create_directories(folder_ / "t");
  std::filesystem::create_directories(folder_ / "a");
  std::filesystem::create_directories(folder_ / "b");
  for (int clip = 0; clip < 6; ++clip) {
    const std::string name = "/c" + std::to_string(clip) + ".csv";
    recon::WriteSkeletons((folder_ / "t").string() + name, ExampleSequence(5));
    recon::WriteSkeletons((folder_ / "a").string() + name,
                          Moved(ExampleSequence(5), 0.01 + 0.001 * clip));
    recon::WriteSkeletons((folder_ / "b").string() + name,
                          Moved(ExampleSequence(5), 0.03 + 0.002 * clip));
  }
  const auto run = RunOssa({"compare", folder_ / "t", folder_ / "a", folder_ / "b", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["results"][0]["clips"].size(), 6u);
  // Clips are 1.0, 1.1, ... 1.5 cm off: their mean is 1.25, and the interval lies around it.
  EXPECT_NEAR(json["results"][0]["mean_joint_error_cm"], 1.25, 1e-3);
  EXPECT_LT(json["results"][0]["confidence_95"]["mean_joint_error_cm"][0], 1.25);
  bool found = false;
  for (const auto& test : json["tests"]) {
    if (test["test"] != "Wilcoxon signed rank" || test["quantity"] != "mean joint error") continue;
    found = true;
    // Six pairs, all in one direction: two of 2^6 sign patterns are as extreme.
    EXPECT_NEAR(test["p"], 2.0 / 64, 1e-12);
  }
  EXPECT_TRUE(found);
}

// A method with a false body keeps its clips in the paired tests.
// Clips of a result without truth were once left out silently.
TEST_F(CompareCommand, ReportsClipsWithoutATruthOfTheSameName) {
  for (const char* name : {"truth/a.jsonl", "truth/b.jsonl", "result/a.jsonl", "result/B.jsonl"}) {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::filesystem::copy_file(truth_, folder_ / name);
  }
  const auto run = RunOssa({"compare", folder_ / "truth", folder_ / "result"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.err.find("1 of its 2 clips have no truth of their name in"), std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("e.g. B"), std::string::npos) << run.err;
}

TEST_F(CompareCommand, PairsClipsWhereAResultHasAnExtraBody) {
  for (const char* name : {"t", "a", "b"}) std::filesystem::create_directories(folder_ / name);
  for (int clip = 0; clip < 6; ++clip) {
    const std::string name = "/c" + std::to_string(clip) + ".jsonl";
    recon::WriteSkeletons((folder_ / "t").string() + name, ExampleSequence(5));
    recon::WriteSkeletons((folder_ / "a").string() + name,
                          Moved(ExampleSequence(5), 0.01 + 0.001 * clip));
    auto haunted = Moved(ExampleSequence(5), 0.03 + 0.002 * clip);
    haunted.frames[2].bodies.push_back(Moved(ExampleSequence(5), 2.0).frames[2].bodies[0]);
    haunted.frames[2].bodies.back().id = 99;
    recon::WriteSkeletons((folder_ / "b").string() + name, haunted);
  }
  const auto run = RunOssa({"compare", folder_ / "t", folder_ / "a", folder_ / "b", "--json"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["results"][1]["clips"][0]["name"], "c0");
  EXPECT_NEAR(json["results"][1]["mean_joint_error_cm"], 3.5, 1e-3);
  ASSERT_FALSE(json["tests"].empty());
  EXPECT_EQ(json["tests"][0]["clips"], 6);
}

TEST_F(CompareCommand, EscapesFileNamesInItsMarkdownTables) {
  const std::string odd = folder_ / "a|b\n<i>.jsonl";
  std::filesystem::copy_file(truth_, odd);
  const auto run = RunOssa({"compare", odd, odd, near_, "--report", folder_ / "out.HTML"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("| a\\|b\\x0A\\<i>.jsonl | near.trc |"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("a|b"), std::string::npos) << run.out;
}

// The name of the file is not valid UTF-8.
TEST_F(CompareCommand, WritesAReportInUtf8ForAnyFileName) {
  const std::string odd = folder_ / "a<\xFF.jsonl", report = folder_ / "r.html";
  std::filesystem::copy_file(near_, odd);
  ASSERT_EQ(RunOssa({"compare", truth_, odd, "--report", report}).exit_status, 0);
  const std::string page = Content(report);
  EXPECT_NE(page.find("a&lt;\\xFF.jsonl"), std::string::npos);
  EXPECT_EQ(page.find('\xFF'), std::string::npos);
}

// A result without people misses everybody: a row of the table, not an error.
TEST_F(CompareCommand, ReportsMissesOfAResultWithoutPeople) {
  auto nobody = ExampleSequence(20);
  for (auto& frame : nobody.frames) frame.bodies.clear();
  const std::string path = folder_ / "nobody.jsonl";
  recon::WriteSkeletons(path, nobody);
  const auto run = RunOssa({"compare", truth_, path, near_, "--json", folder_ / "c.json",
                            "--report", folder_ / "c.html"});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("| mAP 10cm %"), std::string::npos) << run.out;
  const std::string page = Content(folder_ / "c.html");
  EXPECT_NE(page.find("<th>joints missing, %</th>"), std::string::npos);
  EXPECT_NE(page.find("<td>100.0</td>"), std::string::npos);
  EXPECT_EQ(page.find("nan"), std::string::npos);
  const auto json = nlohmann::json::parse(Content(folder_ / "c.json"));
  EXPECT_EQ(json["results"][0]["map_10cm"], 0);
  EXPECT_EQ(json["results"][0]["fraction_joints_missing"], 1);
  EXPECT_TRUE(json["results"][0]["mean_joint_error_cm"].is_null());
  EXPECT_NEAR(json["results"][1]["mean_joint_error_cm"], 2.0, 1e-3);
}

struct BadUse {
  const char* name;
  std::vector<std::string> arguments;
  int status;
  std::string named;
};

void PrintTo(const BadUse& value, std::ostream* out) { *out << value.name; }

class BadCompare : public testing::TestWithParam<BadUse> {};

TEST_P(BadCompare, PrintsOneLineAndExitsWithTheDocumentedStatus) {
  const test::TemporaryFolder folder;
  recon::WriteSkeletons(folder / "good.jsonl", ExampleSequence(3));
  std::ofstream(folder / "empty.jsonl");
  std::ofstream(folder / "junk.jsonl") << "{\"frame\":";
  std::vector<std::string> arguments = {"compare"};
  for (const std::string& argument : GetParam().arguments) {
    arguments.push_back(argument.starts_with("@") ? (folder / argument.substr(1)).string()
                                                  : argument);
  }
  const auto run = RunOssa(arguments);
  EXPECT_EQ(run.exit_status, GetParam().status) << run.err;
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_NE(run.err.find(GetParam().named), std::string::npos) << run.err;
}

INSTANTIATE_TEST_SUITE_P(
    All, BadCompare,
    testing::Values(
        BadUse{"NoResult", {"@good.jsonl"}, 2, "RESULT"},
        BadUse{"Align", {"@good.jsonl", "@good.jsonl", "--align", "scale"}, 2, "--align"},
        BadUse{"Joints", {"@good.jsonl", "@good.jsonl", "--joints", "some"}, 2, "--joints"},
        BadUse{"Time", {"@good.jsonl", "@good.jsonl", "--time", "soon"}, 2, "--time"},
        BadUse{"UnreadOffset",
               {"@good.jsonl", "@good.jsonl", "--time", "none", "--max-offset", "1"},
               2,
               "--max-offset: expected --time auto or correlate"},
        BadUse{"AbsentFile", {"@good.jsonl", "@none.jsonl"}, 1, "none.jsonl"},
        BadUse{"AnotherTime", {"@good.jsonl", "@good.jsonl", "--time", "1000"}, 1, "at the times"},
        BadUse{"EmptyFile", {"@good.jsonl", "@empty.jsonl"}, 1, "empty.jsonl: line 1"},
        BadUse{"Junk", {"@good.jsonl", "@junk.jsonl"}, 1, "junk.jsonl: line 1"},
        BadUse{
            "AbsentFolder", {"@good.jsonl", "@good.jsonl", "--json", "@no/x.json"}, 1, "x.json"}),
    [](const testing::TestParamInfo<BadUse>& info) { return info.param.name; });

struct RealFigure {
  const char* name;
  const char* path;
  const char* skip;
  double mean_cm;
  double relative_cm;
  double offset_removed_cm;
};

void PrintTo(const RealFigure& value, std::ostream* out) { *out << value.name; }

class RealRecordings : public testing::TestWithParam<RealFigure> {};

// The figures of the READMEs of the data, within 0.1 cm, the precision stated there.
TEST_P(RealRecordings, ReproduceTheirPublishedFigures) {
  const RealFigure& figure = GetParam();
  const std::string path = (test::SharedFolder() / "real").string() + figure.path;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  std::vector<std::string> arguments = {"compare", path + "#truth", path + "#observed", "--json"};
  if (*figure.skip != 0) arguments.insert(arguments.end(), {"--skip", figure.skip});
  const auto run = RunOssa(arguments);
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto result = nlohmann::json::parse(run.out)["results"][0];
  EXPECT_NEAR(result["mean_joint_error_cm"], figure.mean_cm, 0.1);
  if (figure.relative_cm > 0) {
    EXPECT_NEAR(result["parent_relative_error_cm"], figure.relative_cm, 0.1);
    EXPECT_NEAR(result["offset_removed_error_cm"], figure.offset_removed_cm, 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, RealRecordings,
    testing::Values(RealFigure{"UiPrmdDevelopmentSubjects", "/uiprmd_kinect_vicon/derived", "_inc",
                               5.67, 6.73, 1.96},
                    RealFigure{"ItopA2jDevelopmentHalf", "/itop_a2j/itop_side_truth_and_a2j.csv.gz",
                               "", 6.28, 0, 0}),
    [](const testing::TestParamInfo<RealFigure>& info) { return info.param.name; });

}  // namespace
}  // namespace ossa
