#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

#include "depth/image/camera_io.h"
#include "depth/image/camera_presets.h"
#include "depth/image/depth_png.h"
#include "depth/image/turn.h"
#include "recon/files/skeleton_io.h"
#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/commands/tracked_folders.h"

namespace ossa::commands {
namespace {

using test::CommandResult;
using test::LineCount;
using test::TemporaryFolder;
using tracker::PersonAt;
using tracker::Rendered;

// rs.align(rs.stream.color): images of the depth camera's size, as the colour camera sees them.
TEST(TrackCommand, RecognisesDepthAlignedToColourByThePeopleInIt) {
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
  EXPECT_EQ(result.err.find("is assumed for images"), std::string::npos) << result.err;
  const auto back = recon::ReadSkeletons((folder / "x.jsonl").string());
  ASSERT_EQ(back.frames.at(0).bodies.size(), 1U);
  const auto& head = back.frames[0].bodies[0].joints[static_cast<size_t>(recon::Joint::kHead)];
  EXPECT_NEAR(head->position_m.x(), 0.4, 0.1) << "0.58 as the depth camera would see it";
  const CommandResult said =
      TrackTo(folder / "still.png", folder / "y.jsonl", {"--camera", "d435"});
  EXPECT_EQ(said.err.find("d435-color"), std::string::npos) << said.err;
}

// A walk beside the image centre, by a camera on its side.
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

TEST(TrackCommand, MirroredImagesGiveTheSkeletonsOfUnmirroredOnes) {
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

struct FlatScene {
  const char* name;
  uint16_t depth_mm;
};
void PrintTo(const FlatScene& scene, std::ostream* out) { *out << scene.name; }

class FramesWithNobody : public testing::TestWithParam<FlatScene> {};

TEST_P(FramesWithNobody, GiveFramesWithoutBodies) {
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

TEST(TrackCommand, TracksAFolderWithGapsInItsNumbersInNameOrder) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "in", 6);
  std::filesystem::remove(folder / "in/000002.png");
  std::filesystem::remove(folder / "in/000003.png");
  const auto out = folder / "x.jsonl";
  EXPECT_EQ(TrackTo(folder / "in", out).exit_status, 0);
  EXPECT_EQ(recon::ReadSkeletons(out.string()).frames.size(), 4U);
}

TEST(TrackCommand, SkipsAndReportsFramesOfAnotherSize) {
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

// A room in centimetres, as one of the units that are recognised as not millimetres.
TEST(TrackCommand, RefusesDepthsOfAnotherUnitUntilAnOptionStatesIt) {
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

TEST(TrackCommand, ReportsADamagedRecordingInOneLine) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  const auto oni = folder / "x.oni";
  std::ofstream(oni, std::ios::binary) << std::string(5000, 'x');
  const CommandResult result = TrackTo(oni, folder / "x.jsonl");
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("x.oni"), std::string::npos) << result.err;
}

// The check for a folder comes before the file is opened.
TEST(TrackCommand, RefusesATooLongSourceName) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  const CommandResult result = TrackTo(std::string(300, 'a'), folder / "x.jsonl");
  EXPECT_EQ(result.exit_status, 1);
  EXPECT_EQ(LineCount(result.err), 1) << result.err;
  EXPECT_NE(result.err.find("expected openni:"), std::string::npos) << result.err;
}

TEST(TrackCommand, EndsWithACompleteFileWhenADeviceDeliversNothing) {
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

// PNGs as PGM images one after the other.
void WritePgms(const std::filesystem::path& folder, const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::binary);
  std::set<std::filesystem::path> pngs;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) pngs.insert(entry.path());
  for (const auto& png : pngs) {
    const auto image = depth::ReadDepthPng(png);
    out << "P5\n" << image.width << " " << image.height << "\n65535\n";
    for (const uint16_t depth : image.data) {
      out.put(static_cast<char>(depth >> 8)).put(static_cast<char>(depth & 255));
    }
  }
}

TEST(TrackCommand, ImagesOnStandardInputGiveTheSkeletonsOfAFolder) {
  OSSA_NEEDS_MODEL();
  const TemporaryFolder folder;
  WriteWalk(folder / "walk", 6);
  WritePgms(folder / "walk", folder / "walk.pgm");
  ASSERT_EQ(TrackTo(folder / "walk", folder / "folder.jsonl", {"--lag", "0"}).exit_status, 0);
  const std::string images = folder / "walk.pgm", out = folder / "pipe.jsonl";
  const CommandResult piped =
      test::RunProgram({"/bin/sh", "-c",
                        "cat " + images + " | " + test::OssaPath() +
                            " track - --fps 30 --method none --out " + out});
  ASSERT_EQ(piped.exit_status, 0) << piped.err;
  EXPECT_NE(piped.out.find("6 frames, 0 dropped"), std::string::npos) << piped.out;
  const auto text = [&](const char* name) {
    std::ifstream file(folder / name);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_EQ(text("pipe.jsonl"), text("folder.jsonl"));
}

TEST(TrackCommand, RefusesStandardInputAmongSeveralSources) {
  const TemporaryFolder folder;
  const CommandResult result =
      test::RunOssa({"track", "-", folder.path().string(), "--out", folder / "x.jsonl"});
  EXPECT_EQ(result.exit_status, 2);
  EXPECT_NE(result.err.find("-: expected recordings where there are several sources"),
            std::string::npos)
      << result.err;
}

}  // namespace
}  // namespace ossa::commands
