#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "depth/image/camera_presets.h"
#include "depth/image/depth_png.h"
#include "recon/files/skeleton_io.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/commands/tracked_folders.h"

namespace ossa::commands {
namespace {

using test::CommandResult;
using test::RunOssa;
using test::TemporaryFolder;
using test::WriteExampleFolder;
using tracker::PersonAt;

class OutputFormats : public testing::TestWithParam<const char*> {};

TEST_P(OutputFormats, AreReadBackByCompare) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 6);
  const auto out = (folder / "x").replace_extension(GetParam());
  const CommandResult result = TrackTo(folder / "in", out, {}, "shum-2013");
  ASSERT_EQ(result.exit_status, 0) << result.err;
  const recon::SkeletonSequence back = recon::ReadSkeletons(out.string());
  ASSERT_EQ(back.frames.size(), 6U);
  for (const auto& frame : back.frames) EXPECT_EQ(frame.bodies.size(), 1U);
}

TEST(TrackCommand, AllFormatsAgreeInAnIndependentReader) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 6);
  for (const char* format : {".jsonl", ".csv", ".trc", ".bvh"}) {
    const auto out = (folder / "x").replace_extension(format);
    const CommandResult result = TrackTo(folder / "in", out, {}, "shum-2013");
    ASSERT_EQ(result.exit_status, 0) << result.err;
  }
  const std::string script = test::SourceFolder() / "tests/tools/commands/read_outputs.py";
  const CommandResult read =
      test::RunProgram({"/usr/bin/python3", script, (folder / "x").string()});
  EXPECT_EQ(read.exit_status, 0) << read.err;
  EXPECT_EQ(read.out, "agree 6 frames\n");
}

INSTANTIATE_TEST_SUITE_P(TrackCommand, OutputFormats, testing::Values("jsonl", "trc", "csv", "bvh"),
                         [](const auto& info) { return std::string(info.param); });

TEST(TrackCommand, PrintsTheFrameCountAndWritesMillisecondsPerStage) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 4);
  const auto stats = folder / "stats.json";
  const CommandResult result =
      TrackTo(folder / "in", folder / "x.jsonl", {"--json-stats", stats.string()});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_EQ(result.out, "4 frames, 0 dropped, 0 reconnections\n");
  const auto json = nlohmann::json::parse(std::ifstream(stats));
  EXPECT_EQ(json.at("frames"), 4);
  for (const char* stage :
       {"segment", "classify", "propose", "reconstruct", "physics", "total", "total_p99"}) {
    EXPECT_TRUE(json.at("ms").at(stage).is_number()) << stage;
  }
  EXPECT_GT(json.at("fps"), 0.0);
  EXPECT_GT(json.at("peak_rss_mb"), 1.0);
}

// The first candidate of a frame that a rule decided about, or null.
nlohmann::json FindDecision(const nlohmann::json& frame, const std::string& rule) {
  for (const auto& candidate : frame.at("candidates")) {
    if (candidate.at("rule") == rule) return candidate;
  }
  return {};
}

// A person beside a small box, a board and a wardrobe, as one image in a folder.
void WritePersonAndFurniture(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  tests::CapsuleScene scene;
  scene.people = {PersonAt(-0.9, 2.6)};
  scene.planes = tests::EmptyRoom();
  scene.boxes = {{{-0.05, -0.1, 2.5}, {0.08, 0.1, 2.6}},  // too small
                 {{0.4, -0.5, 2.2}, {0.75, 0.1, 2.25}},   // a board
                 {{1.1, -1.0, 3.0}, {2.0, 0.9, 3.5}}};    // a wardrobe
  const auto render = tests::Render(scene, depth::KinectV1Camera(320, 240));
  depth::WriteDepthPng(folder / "0.png", render.frame.view());
}

TEST(TrackCommand, TracesTheDecidingRuleOfEveryCandidate) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WritePersonAndFurniture(folder / "in");
  const auto trace = folder / "trace.jsonl";
  const CommandResult result = RunOssa({"track", folder / "in", "--trace", trace.string()});
  ASSERT_EQ(result.exit_status, 0) << result.err;
  std::ifstream file(trace);
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  const auto frame = nlohmann::json::parse(line);
  EXPECT_EQ(frame.at("frame"), 0);
  EXPECT_TRUE(frame.at("fresh_scene"));
  const auto person = FindDecision(frame, "fresh_scene");
  ASSERT_FALSE(person.is_null()) << line;
  EXPECT_EQ(person.at("outcome"), "confirmed");
  EXPECT_EQ(person.at("track"), 1);
  EXPECT_NEAR(person.at("place_m").at(0), -0.9, 0.1);
  EXPECT_GE(person.at("score"), person.at("needed_score"));
  for (const auto& [rule, x_m] :
       {std::pair("too_small", 0.0), {"planar", 0.57}, {"furniture", 1.5}}) {
    const auto decision = FindDecision(frame, rule);
    ASSERT_FALSE(decision.is_null()) << rule << ": " << line;
    EXPECT_FALSE(decision.contains("track")) << rule;
    EXPECT_GT(decision.at("why").get<std::string>().size(), 20U);
    if (rule != std::string("furniture")) {
      EXPECT_NEAR(decision.at("place_m").at(0), x_m, 0.1);
    }
  }
  ASSERT_EQ(frame.at("tracks").size(), 1U);
  EXPECT_EQ(frame.at("tracks").at(0).at("status"), "confirmed");
  EXPECT_FALSE(std::getline(file, line));
}

TEST(TrackCommand, RefusesATraceOfAnotherFormatOrOfTheNameOfAnotherOutput) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  WriteExampleFolder(folder / "in", 1);
  const auto track = [&](const std::string& trace) {
    return RunOssa({"track", folder / "in", "--out", folder / "x.jsonl", "--trace", trace})
        .exit_status;
  };
  EXPECT_EQ(track(folder / "trace.csv"), 2);
  EXPECT_EQ(track(folder / "x.jsonl"), 2);
}

TEST(TrackCommand, WritesTheSameBytesForAnyNumberOfThreads) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 5);
  const auto bytes = [&](const std::string& name, const std::string& threads) {
    const auto out = folder / name;
    const CommandResult result = TrackTo(
        folder / "in", out, {"--physics", "on", "--hinges", "--joint-limits", "--threads", threads},
        "shum-2013");
    EXPECT_EQ(result.exit_status, 0) << result.err;
    std::ifstream file(out, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(bytes("a.jsonl", "1"), bytes("b.jsonl", "2"));
}

TEST(TrackCommand, WritesOnePictureOfFourPanels) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 2);
  const auto picture = folder / "p.png";
  EXPECT_EQ(RunOssa({"track", (folder / "in").string(), "--method", "none", "--picture",
                     picture.string()})
                .exit_status,
            0);
  EXPECT_GT(std::filesystem::file_size(picture), 1000U);
}

TEST(TrackCommand, RefusesAnUnknownExtensionBeforeTracking) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  const CommandResult result = TrackTo(folder.path(), folder / "x.doc");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("x.doc"), std::string::npos) << result.err;
}

// A recording or a data set would be lost.
TEST(TrackCommand, RefusesToOverwriteItsInput) {
  const TemporaryFolder folder;
  WriteWalk(folder / "data/depth", 2);
  std::ofstream(folder / "data/manifest.json") << "{}";
  WriteWalk(folder / "frames", 2);
  const auto data = (folder / "data").string(), frames = (folder / "frames").string();
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{data, "--pictures", data + "/depth"},
                                             {data, "--json-stats", data + "/manifest.json"},
                                             {data, "--picture", data + "/depth/000001.png"},
                                             {frames, "--pictures", frames},
                                             {frames, "--picture", frames + "/000001.png"}}) {
    std::vector<std::string> command = {"track"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const CommandResult result = RunOssa(command);
    EXPECT_EQ(result.exit_status, 2) << result.err;
    EXPECT_NE(result.err.find(arguments[2] + ": expected an output other than"), std::string::npos)
        << result.err;
  }
}

}  // namespace
}  // namespace ossa::commands
