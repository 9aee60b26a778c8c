#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "depth/image/camera_io.h"
#include "depth/image/camera_presets.h"
#include "depth/image/depth_png.h"
#include "depth/image/turn.h"
#include "depth/sensor/oni_recorder.h"
#include "recon/files/skeleton_io.h"
#include "tests/support/depth_examples.h"
#include "tests/support/places.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/commands/tracked_folders.h"

namespace ossa::commands {
namespace {

using std::chrono::milliseconds;
using test::CommandResult;
using test::LineCount;
using test::RunningCommand;
using test::RunOssa;
using test::StartOssa;
using test::TemporaryFolder;
using test::WriteExampleFolder;
using tracker::ModelOrNothing;
using tracker::PersonAt;
using tracker::Rendered;

class OutputFormats : public testing::TestWithParam<const char*> {};

TEST_P(OutputFormats, AreReadBackByTheReadersOfCompare) {
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

// rs.align(rs.stream.color): images of the depth camera's size, as the colour camera sees them.
TEST(TrackCommand, DepthAlignedToColourIsToldByThePeopleInIt) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  tests::CapsuleScene scene;
  scene.people = {PersonAt(0.4, 2.8)};
  scene.people[0].height_m = 2.1;  // the capsule person is slim
  scene.planes = tests::EmptyRoom();
  const auto render = tests::Render(scene, depth::PresetCamera("d435-color", 640, 360));
  depth::WriteDepthPng(folder / "still.png", render.frame.view());
  const CommandResult result = TrackTo(folder / "still.png", folder / "x.jsonl");
  ASSERT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("--camera d435-color (f 461 px)"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("are taken for"), std::string::npos) << result.err;
  const auto back = recon::ReadSkeletons((folder / "x.jsonl").string());
  ASSERT_EQ(back.frames.at(0).bodies.size(), 1U);
  const auto& head = back.frames[0].bodies[0].joints[static_cast<size_t>(recon::Joint::kHead)];
  EXPECT_NEAR(head->position_m.x(), 0.4, 0.1) << "0.58 as the depth camera would see it";
  const CommandResult said =
      TrackTo(folder / "still.png", folder / "y.jsonl", {"--camera", "d435"});
  EXPECT_EQ(said.err.find("d435-color"), std::string::npos) << said.err;
}

// A walk off the middle, by a camera on its side.
void WriteTurnedWalk(const std::filesystem::path& folder, bool mirrored) {
  std::filesystem::create_directories(folder);
  for (int i = 0; i < 3; ++i) {
    depth::DepthFrame frame = depth::Turned(Rendered({PersonAt(0.4, 2.6)}, i).frame, 1);
    frame.camera.cx += 3.0;
    if (mirrored) frame = depth::Unmirrored(frame);
    depth::WriteDepthPng(folder / (std::to_string(i) + ".png"), frame.view());
    depth::WriteCameraJson(folder / "camera.json", frame.camera);
  }
}

TEST(TrackCommand, MirroredImagesGiveTheSkeletonsOfThoseThatAreNot) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteTurnedWalk(folder / "plain", false);
  WriteTurnedWalk(folder / "mirrored", true);
  const auto track = [&](const char* images, std::vector<std::string> options) {
    options.insert(options.end(), {"--rotate", "270"});
    const CommandResult result = TrackTo(folder / images, folder / "x.jsonl", options);
    EXPECT_EQ(result.exit_status, 0) << result.err;
    std::ifstream file(folder / "x.jsonl");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const std::string plain = track("plain", {});
  EXPECT_NE(plain.find("HandLeft"), std::string::npos);
  EXPECT_EQ(track("mirrored", {"--mirrored"}), plain);
  EXPECT_NE(track("mirrored", {}), plain);
}

TEST(TrackCommand, AllFormatsSayTheSameToAReaderThatIsNotOurs) {
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

TEST(TrackCommand, SaysHowManyFramesAndWritesEveryStagesMilliseconds) {
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

TEST(TrackCommand, SaysThatNobodyWasFoundAndWhatMayBeWrong) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  WriteFlat(folder / "in", 2000, 2);
  const CommandResult result = TrackTo(folder / "in", folder / "x.jsonl");
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_NE(result.err.find("nobody was found, by a camera of f 144 px"), std::string::npos)
      << result.err;
  const CommandResult quiet = TrackTo(folder / "in", folder / "y.jsonl", {"--quiet"});
  EXPECT_EQ(quiet.err, "");
  WriteWalk(folder / "walk", 2);
  const CommandResult walk = TrackTo(folder / "walk", folder / "z.jsonl");
  EXPECT_EQ(walk.err.find("nobody"), std::string::npos) << walk.err;
}

// The first candidate of a frame that a rule decided about, or null.
nlohmann::json FindDecision(const nlohmann::json& frame, const std::string& rule) {
  for (const auto& candidate : frame.at("candidates")) {
    if (candidate.at("rule") == rule) return candidate;
  }
  return {};
}

TEST(TrackCommand, TracesWhichRuleDecidedAboutEveryPieceOfTheScene) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "in");
  tests::CapsuleScene scene;
  scene.people = {PersonAt(-0.9, 2.6)};
  scene.planes = tests::EmptyRoom();
  scene.boxes = {{{-0.05, -0.1, 2.5}, {0.08, 0.1, 2.6}},  // too small
                 {{0.4, -0.5, 2.2}, {0.75, 0.1, 2.25}},   // a board
                 {{1.1, -1.0, 3.0}, {2.0, 0.9, 3.5}}};    // a wardrobe
  const auto render = tests::Render(scene, depth::KinectV1Camera(320, 240));
  depth::WriteDepthPng(folder / "in/0.png", render.frame.view());
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

TEST(TrackCommand, RefusesATraceThatIsNoJsonLinesOrAnotherOutput) {
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

TEST(TrackCommand, SameFramesSameSeedSameBytesWhateverTheThreads) {
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

struct FlatScene {
  const char* name;
  uint16_t depth_mm;
};
void PrintTo(const FlatScene& scene, std::ostream* out) { *out << scene.name; }

class FramesWithNobody : public testing::TestWithParam<FlatScene> {};

TEST_P(FramesWithNobody, GiveEmptyFramesNotPeople) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteFlat(folder.path(), GetParam().depth_mm, 3);
  const auto out = folder / "x.jsonl";
  const CommandResult result = TrackTo(folder.path(), out);
  EXPECT_EQ(result.exit_status, 0) << result.err;
  const auto back = recon::ReadSkeletons(out.string());
  ASSERT_EQ(back.frames.size(), 3U);
  for (const auto& frame : back.frames) EXPECT_TRUE(frame.bodies.empty());
}

INSTANTIATE_TEST_SUITE_P(TrackCommand, FramesWithNobody,
                         testing::Values(FlatScene{"allZero", 0}, FlatScene{"allFar", 9000},
                                         FlatScene{"allNear", 500}, FlatScene{"allMost", 65535}),
                         [](const auto& info) { return info.param.name; });

TEST(TrackCommand, AFolderWithGapsInItsNumbersIsTrackedInNameOrder) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 6);
  std::filesystem::remove(folder / "in/000002.png");
  std::filesystem::remove(folder / "in/000003.png");
  const auto out = folder / "x.jsonl";
  EXPECT_EQ(TrackTo(folder / "in", out).exit_status, 0);
  EXPECT_EQ(recon::ReadSkeletons(out.string()).frames.size(), 4U);
}

TEST(TrackCommand, FramesOfAnotherSizeAreSkippedAndToldOf) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  for (const char* name : {"a.png", "c.png"}) {
    depth::WriteDepthPng(folder / name, test::ExampleFrame(0, 64, 48).view());
  }
  depth::WriteDepthPng(folder / "b.png", test::ExampleFrame(1, 32, 24).view());
  const auto out = folder / "x.jsonl";
  const CommandResult result = TrackTo(folder.path(), out, {"--quiet"});
  EXPECT_EQ(result.exit_status, 0);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("skipped 1 of 3 frames"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("b.png"), std::string::npos) << result.err;
  EXPECT_EQ(recon::ReadSkeletons(out.string()).frames.size(), 2U);
}

// Of a room in centimetres, as of anything that cannot be millimetres.
TEST(TrackCommand, DepthsOfAnotherUnitAreRefusedUntilAnOptionReadsThem) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  depth::DepthFrame frame = Rendered({PersonAt(0, 2.6)}, 0).frame;
  for (uint16_t& depth : frame.depth_mm) depth = static_cast<uint16_t>(depth / 10);
  depth::WriteDepthPng(folder / "0.png", frame.view());
  const auto out = folder / "x.jsonl";
  const CommandResult refused = TrackTo(folder.path(), out, {"--quiet"});
  EXPECT_EQ(refused.exit_status, 1);
  EXPECT_EQ(LineCount(refused.err), 1) << refused.err;
  EXPECT_NE(refused.err.find("--depth-scale 100 reads them"), std::string::npos) << refused.err;
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(TrackTo(folder.path(), out, {"--depth-scale", "100"}).exit_status, 0);
}

TEST(TrackCommand, ADamagedRecordingEndsWithOneLineThatNamesIt) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  const auto oni = folder / "x.oni";
  std::ofstream(oni, std::ios::binary) << std::string(5000, 'x');
  const CommandResult result = TrackTo(oni, folder / "x.jsonl");
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("x.oni"), std::string::npos) << result.err;
}

// Whether it is a folder is asked before it is opened.
TEST(TrackCommand, ANameThatIsTooLongIsNoSource) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  const CommandResult result = TrackTo(std::string(300, 'a'), folder / "x.jsonl");
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("expected openni:"), std::string::npos) << result.err;
}

TEST(TrackCommand, AMissingModelIsNamed) {
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  const CommandResult result =
      TrackTo(folder.path(), folder / "x.jsonl", {"--model", "/nowhere/m.ossa"});
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("/nowhere/m.ossa"), std::string::npos) << result.err;
}

TEST(TrackCommand, AnUnknownExtensionIsRefusedBeforeAnythingIsTracked) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteExampleFolder(folder.path(), 1);
  const CommandResult result = TrackTo(folder.path(), folder / "x.doc");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("x.doc"), std::string::npos) << result.err;
}

TEST(TrackCommand, WrongUsageExitsWithTwo) {
  EXPECT_EQ(RunOssa({"track"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"track", "."}).exit_status, 2);
  EXPECT_EQ(RunOssa({"track", ".", "--out", "x.jsonl", "--users", "7"}).exit_status, 2);
  EXPECT_EQ(RunOssa({"track", ".", "--out", "x.jsonl", "--seed", "-1"}).exit_status, 2);
  EXPECT_EQ(
      RunOssa({"track", ".", "--out", "x.jsonl", "--frames", "99999999999999999999"}).exit_status,
      2);
  EXPECT_EQ(RunOssa({"track", ".", "--out", "x.jsonl", "--method", "magic"}).exit_status, 2);
}

TEST(TrackCommand, SaysWhichFilesTheMethodDoesNotRead) {
  const auto said = [](std::vector<std::string> options) {
    std::vector<std::string> arguments = {"track",   "/nonexistent", "--out",
                                          "x.jsonl", "--method",     "kalman"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CommandResult result = RunOssa(arguments);
    EXPECT_EQ(result.exit_status, 1);  // for what is to be tracked
    return result.err.find(options[options.size() - 2] + " is not read by --method kalman") !=
           std::string::npos;
  };
  for (const char* option : {"--refinement", "--learned", "--prior", "--database"})
    EXPECT_TRUE(said({option, "x.file"})) << option;
  // Where there is none of it nothing is lost, and raw joints may be looked at again.
  EXPECT_FALSE(said({"--refinement", "none"}));
  EXPECT_FALSE(said({"--learned", "none"}));
  EXPECT_FALSE(said({"--posture", "refined", "--refinement", "/no.refine"}));
}

TEST(TrackCommand, SaysThatAPageIsAskedForByView) {
  const std::vector<std::string> words = {"track", "in", "--out", "x.jsonl", "--port", "9"};
  const auto says_so = [](std::vector<std::string> all, const std::vector<std::string>& more) {
    all.insert(all.end(), more.begin(), more.end());
    const std::string err = RunOssa(all).err;
    return err.find("ossa: --port is not read without --view\n") != std::string::npos;
  };
  EXPECT_TRUE(says_so(words, {}));
  EXPECT_FALSE(says_so(words, {"--quiet"}));
  EXPECT_FALSE(says_so(words, {"--view"}));
}

TEST(TrackCommand, BonesByTheWholeRecordingAreTheSameInEveryFrame) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 20);
  const auto drift = [&](const char* bones) {
    const auto out = folder / (std::string(bones) + ".jsonl");
    const CommandResult result = TrackTo(folder / "in", out, {"--bones", bones}, "best");
    EXPECT_EQ(result.exit_status, 0) << result.err;
    double worst = 0.0;
    std::optional<recon::BoneLengths> first;
    for (const auto& frame : recon::ReadSkeletons(out.string()).frames) {
      if (frame.bodies.empty()) continue;
      const auto lengths_m =
          recon::MeasureBoneLengths(recon::ToTrackedPosture(frame.bodies[0]).posture);
      if (!first) first = lengths_m;
      for (size_t i = 1; i < recon::kJointCount; ++i)
        worst = std::max(worst, std::abs(lengths_m[i] / (*first)[i] - 1.0));
    }
    EXPECT_TRUE(first.has_value());
    return worst;
  };
  EXPECT_GT(drift("so-far"), 1e-3);
  EXPECT_LT(drift("recording"), 1e-3);
}

TEST(TrackCommand, OfSomebodySeatedHasTheUpperTenJoints) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 3);
  for (const char* name : {"x.jsonl", "x.trc"}) {
    const CommandResult result =
        TrackTo(folder / "in", folder / name, {"--mode", "seated"}, "best");
    ASSERT_EQ(result.exit_status, 0) << result.err;
    const recon::SkeletonSequence written = recon::ReadSkeletons((folder / name).string());
    const auto& frame = written.frames.back();
    ASSERT_FALSE(frame.bodies.empty());
    const auto& joints = frame.bodies[0].joints;
    EXPECT_EQ(std::count_if(joints.begin(), joints.end(), [](const auto& j) { return bool(j); }),
              10);
  }
}

// A recording or a data set would be gone.
TEST(TrackCommand, NeverWritesOverTheFramesItReads) {
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
    EXPECT_NE(result.err.find(arguments[2] + ": expected a new file"), std::string::npos)
        << result.err;
  }
}

TEST(TrackCommand, BonesByTheWholeRecordingNeedARecordingAndAMethodThatKeepsThem) {
  const TemporaryFolder folder;
  WriteFlat(folder.path(), 3000, 1);
  const auto out = folder / "x.jsonl";
  CommandResult result = TrackTo(folder.path(), out, {"--bones", "recording"}, "kalman");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("found kalman"), std::string::npos) << result.err;
  result =
      TrackTo("openni:ossa://" + folder.path().string(), out, {"--bones", "recording"}, "best");
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("expected a recording"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(TrackCommand, ADeviceThatDeliversNothingEndsTheRunAndTheFileIsWhole) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 5);
  const auto out = folder / "x.jsonl";
  // The virtual device plays five frames once and is silent then.
  const CommandResult result =
      TrackTo("openni:ossa://" + (folder / "in").string(), out, {"--patience", "1"});
  EXPECT_EQ(result.exit_status, 0) << result.err;
  EXPECT_GE(recon::ReadSkeletons(out.string()).frames.size(), 1U);
}

TEST(TrackCommand, CtrlCEndsCleanlyAndTheFileIsWhole) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 20);
  const auto out = folder / "x.jsonl";
  RunningCommand command =
      StartOssa({"track", "openni:ossa://" + (folder / "in").string() + "?loop=1", "--out",
                 out.string(), "--method", "none", "--view", "--port", "0"});
  ASSERT_TRUE(command.WaitForError("watch at", test::kCommandTimeout));
  std::this_thread::sleep_for(milliseconds(1500));
  command.Signal(SIGINT);
  const CommandResult result = command.Wait(test::kCommandTimeout);
  EXPECT_FALSE(result.timed_out);
  if (std::filesystem::exists(out)) {
    EXPECT_GE(recon::ReadSkeletons(out.string()).frames.size(), 1U);
  } else {
    EXPECT_NE(result.exit_status, 0) << "no frame came, and nobody said so";
  }
}

}  // namespace
}  // namespace ossa::commands
