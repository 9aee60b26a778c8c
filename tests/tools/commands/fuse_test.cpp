// `ossa fuse` as a process: synthetic people recorded by two cameras.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "recon/body/body_model.h"
#include "recon/files/skeleton_io.h"
#include "recon/fuse/extrinsics.h"
#include "tests/recon/fuse/moving_people.h"
#include "tests/support/depth_examples.h"
#include "tests/support/run_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/tracked_scenes.h"

namespace ossa {
namespace {

using recon::test::FromTheSide;
using recon::test::MadeUpCamera;
using test::RunOssa;
using tracker::ModelOrNothing;  // of OSSA_NEEDS_MODEL

// Mean distance of the first person's joints from the truth, frame by frame.
double MeanError_m(const recon::SkeletonSequence& truth, const std::string& result) {
  const auto found = recon::ReadSkeletons(result);
  double sum_m = 0.0;
  size_t count = 0;
  for (size_t f = 0; f < truth.frames.size(); ++f) {
    if (found.frames.at(f).bodies.empty()) continue;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      const auto& joint = found.frames[f].bodies[0].joints[j];
      sum_m += (joint->position_m - truth.frames[f].bodies[0].joints[j]->position_m).norm();
      ++count;
    }
  }
  return sum_m / static_cast<double>(count);
}

class FuseCommand : public testing::Test {
 protected:
  FuseCommand() {
    const std::vector<double> one = {0.0};
    recon::WriteSkeletons(front_, recon::test::Record({.noise_m = 0.01}, one, 120));
    recon::WriteSkeletons(side_, recon::test::Record({FromTheSide(), 0.3, 0.01, 2}, one, 120));
  }
  // The text on stderr; expects the exit status.
  std::string Said(std::vector<std::string> words, int exit_status) {
    words.insert(words.begin(), "fuse");
    const auto run = RunOssa(words);
    EXPECT_EQ(run.exit_status, exit_status) << run.err;
    return run.err;
  }
  test::TemporaryFolder folder_;
  std::string front_ = folder_ / "front.jsonl", side_ = folder_ / "side.jsonl";
  std::string out_ = folder_ / "both.jsonl", room_ = folder_ / "room.json";
};

TEST_F(FuseCommand, EstimatesPrintsAndSavesExtrinsics) {
  const auto run = RunOssa({"fuse", front_, side_, "--out", out_, "--save-extrinsics", room_});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  EXPECT_NE(run.out.find("side: 3.3"), std::string::npos) << run.out;
  const auto cameras = recon::ReadExtrinsics(room_);
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[1].name, "side");
  EXPECT_NEAR(cameras[1].clock_offset_s, 0.3, 1.0 / 30);
  EXPECT_EQ(recon::ReadSkeletons(out_).frames.size(), 120u);
}

TEST_F(FuseCommand, ReadsExtrinsicsByCameraNameInAnyOrder) {
  recon::WriteExtrinsics(room_, {{.name = "side"}, {"front", FromTheSide().inverse(), -0.3}});
  ASSERT_EQ(Said({front_, side_, "--extrinsics", room_, "--out", out_, "--quiet"}, 0), "");
  const auto fused = recon::ReadSkeletons(out_);
  const auto truth = recon::test::WalkerAt(fused.frames[60].time_s);
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const auto& joint = fused.frames[60].bodies.at(0).joints[j];
    EXPECT_LT((joint->position_m - truth.position_m[j]).norm(), 0.05);  // the noise
  }
}

TEST_F(FuseCommand, ReportsUnusableInputInOneLine) {
  const std::string empty = folder_ / "empty.jsonl", nobody = folder_ / "nobody.jsonl";
  std::ofstream(empty).flush();
  std::ofstream(nobody) << R"({"frame":0,"time_s":0.0,"bodies":[]})"
                        << "\n";
  recon::WriteExtrinsics(room_, {{.name = "alone"}});
  const std::vector<std::pair<std::vector<std::string>, std::string>> failures = {
      {{front_, empty, "--out", out_}, "empty.jsonl: line 1"},
      {{front_, nobody, "--out", out_}, "nobody.jsonl: expected a person whom both cameras see"},
      {{nobody, side_, "--out", out_}, "nobody.jsonl: expected a person whom both cameras see"},
      {{front_, side_, "--out", out_, "--extrinsics", room_}, "as many as there are recordings, 2"},
      {{front_, side_, "--out", out_, "--extrinsics", front_}, "front.jsonl"},
      {{front_, folder_ / "none.jsonl", "--out", out_}, "none.jsonl: no such file"}};
  for (const auto& [words, said] : failures) {
    EXPECT_NE(Said(words, 1).find(said), std::string::npos) << said;
    EXPECT_FALSE(std::filesystem::exists(out_));
  }
}

TEST_F(FuseCommand, RefusesWrongUsage) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{front_, "--out", out_}, "expected two or more recordings, found 1"},
      {{front_, side_}, "name --out or --save-extrinsics"},
      {{front_, side_, "--out", side_},
       "expected an output other than the inputs, found the input"},
      {{front_, side_, "--out", folder_ / "x.png"}, "x.png"},
      {{front_, side_, "--out", out_, "--save-extrinsics", folder_ / "x.bvh"}, "ends in .json"},
      {{front_, front_, "--out", out_}, "front.jsonl: expected a recording of each camera"},
      {{front_, side_, "--out", out_, "--extrinsics", room_, "--max-offset", "1"},
       "--max-offset: expected --extrinsics auto with it"},
      {{front_, side_, "--out", out_, "--max-offset", "-1"}, "--max-offset"}};
  for (const auto& [words, said] : cases) {
    EXPECT_NE(Said(words, 2).find(said), std::string::npos) << said;
  }
}

// One rendered person, seen by two cameras from different sides.
class TwoRenderedCameras : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!recon::BodyIsFetched(recon::BodyFolder())) return;
    folder_.emplace();
    const auto run = RunOssa({"render", "--mocap", "authored", "--frames", "30", "--out", Clip(),
                              "--size", "320x240", "--sequence", "--cameras", "2", "--split",
                              "test", "--seed", "4", "--quiet"});
    ASSERT_EQ(run.exit_status, 0) << run.err;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    if (!folder_) GTEST_SKIP() << "no body: tools/fetch_body";
    OSSA_NEEDS_MODEL();
  }
  static std::string Clip() { return *folder_ / "clip"; }
  static std::string Set(int camera) { return Clip() + "/camera_" + std::to_string(camera); }
  static std::string Room() { return Clip() + "/extrinsics.json"; }
  // Runs `ossa track` on the sources; returns the path of its skeletons.
  static std::string Tracked(const std::string& name, std::vector<std::string> words) {
    const std::string out = *folder_ / name;
    words.insert(words.begin(), "track");
    words.insert(words.end(), {"--out", out, "--quiet"});
    const auto run = RunOssa(words);
    EXPECT_EQ(run.exit_status, 0) << run.err;
    return out;
  }
  static inline std::optional<test::TemporaryFolder> folder_;
};

TEST_F(TwoRenderedCameras, FusedHaveASmallerErrorThanTheFirstAlone) {
  const std::string alone = Tracked("camera_0.jsonl", {Set(0)});
  const std::string other = Tracked("camera_1.jsonl", {Set(1)});
  const std::string out = *folder_ / "fused.jsonl";
  const auto run = RunOssa({"fuse", alone, other, "--out", out, "--extrinsics", Room()});
  ASSERT_EQ(run.exit_status, 0) << run.err;
  const auto truth = recon::ReadSkeletons(Set(0) + "/truth.jsonl");
  EXPECT_LT(MeanError_m(truth, out), 0.95 * MeanError_m(truth, alone));
  // Tracked together they are equal, but for the rounding of the files.
  const std::string at_once = Tracked("at_once.jsonl", {Set(0), Set(1), "--extrinsics", Room()});
  EXPECT_LT(MeanError_m(recon::ReadSkeletons(out), at_once), 1e-4);
}

TEST_F(TwoRenderedCameras, ExtrinsicsAreEstimatedWhileTracking) {
  const std::string found = *folder_ / "found.json";
  Tracked("found.jsonl", {Set(0), Set(1), "--save-extrinsics", found});
  const auto camera = recon::ReadExtrinsics(found).at(1),
             truth = recon::ReadExtrinsics(Room()).at(1);
  const Eigen::Isometry3d off = camera.from_camera_0 * truth.from_camera_0.inverse();
  // One second of a person two metres away, in images 320 pixels wide.
  EXPECT_LT(off.translation().norm(), 0.3);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), 0.1);
  EXPECT_NEAR(camera.clock_offset_s, 0.0, 1.0 / 30);
}

// Images of a wall show nobody: extrinsics cannot be estimated, the tracked files stay.
TEST(TrackOfSeveralSources, KeepsTheSkeletonsOfEachCameraWhereFusionFails) {
  const test::TemporaryFolder folder;
  for (const char* name : {"left", "right"}) {
    std::filesystem::create_directory(folder / name);
    test::WriteExampleFolder(folder / name, 3);
  }
  const auto run = RunOssa({"track", folder / "left", folder / "right", "--out",
                            folder / "both.jsonl", "--method", "none", "--quiet"});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_EQ(test::LineCount(run.err), 1) << run.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "both.jsonl"));
  for (const char* name : {"left", "right"}) {
    const std::string kept = folder / "both.cameras" / (std::string(name) + ".jsonl");
    EXPECT_NE(run.err.find(kept), std::string::npos) << run.err;
    EXPECT_EQ(recon::ReadSkeletons(kept).frames.size(), 3u);
  }
}

TEST(TrackOfSeveralSources, RefusesOptionsOfASingleSourceAndDevices) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"a", "b", "--out", "x.jsonl", "--view"}, "--view: expected one source with it"},
      {{"a", "b", "--out", "x.jsonl", "--scene", "s"}, "--scene: expected one source with it"},
      {{"a", "--out", "x.jsonl", "--extrinsics", "r"}, "--extrinsics: expected several sources"},
      {{"openni:", "b", "--out", "x.jsonl"}, "openni:: expected recordings"}};
  for (auto [words, said] : cases) {
    words.insert(words.begin(), "track");
    const auto run = RunOssa(words);
    EXPECT_EQ(run.exit_status, 2) << said;
    EXPECT_NE(run.err.find(said), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace ossa
