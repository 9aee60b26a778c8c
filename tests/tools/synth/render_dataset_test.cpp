// Rendering stops and goes on under every new option, with one thread or two: the same bytes.
#include "tools/synth/render_dataset.h"

#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <iterator>

#include "recon/motion/mocap.h"
#include "tests/support/refused.h"
#include "tests/support/temporary_folder.h"
#include "tools/synth/clothed_body.h"

namespace ossa::tools {
namespace {

namespace fs = std::filesystem;

FrameOptions EverythingAtOnce() {
  FrameOptions options;
  options.sensors = {depth::SensorKind::kXtion, depth::SensorKind::kAzure,
                     depth::SensorKind::kD4xx};
  options.cameras = Cameras::kAny;
  options.occluders = Occluders::kAll;
  options.hanging_clothes = options.ends = true;
  options.variation = MakeVariation(Poses::kAny);
  options.view = View::kCeiling;
  options.width = 64;
  options.height = 48;
  return options;
}

std::string Bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RenderDataset, ResumesWithTheSameBytes) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  const FrameInputs inputs(LoadFetchedBody(), MakePoseBank(recon::LoadMocap({"authored-floor"})),
                           EverythingAtOnce());
  RenderJob job;
  job.frames = 80;  // two shards
  job.png = false;
  job.packed = true;
  job.command = "test";
  job.threads = 2;
  job.out = folder / "once";
  ASSERT_EQ(RenderShare(inputs, job), RenderEnd::kDone);
  FinishDataset(inputs, job);
  job.threads = 1;
  job.out = folder / "twice";
  std::atomic<int> asked = 0;
  job.interrupted = [&] { return ++asked > 70; };
  ASSERT_EQ(RenderShare(inputs, job), RenderEnd::kInterrupted);
  job.interrupted = [] { return false; };
  ASSERT_EQ(RenderShare(inputs, job), RenderEnd::kDone);
  FinishDataset(inputs, job);
  for (const char* file : {"manifest.json", "shards/000000.shard", "shards/000001.shard"}) {
    EXPECT_FALSE(Bytes(fs::path(folder / "once") / file).empty());
    EXPECT_EQ(Bytes(fs::path(folder / "once") / file), Bytes(fs::path(folder / "twice") / file));
  }
}

// A file of motion was edited between a run that was stopped and the next of the same command.
TEST(RenderDataset, DoesNotMixFramesOfTwoMotions) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  FrameOptions options;
  options.width = 64;
  options.height = 48;
  auto poses = MakePoseBank(recon::LoadMocap({"authored-floor"}));
  poses.resize(3);
  const FrameInputs before(LoadFetchedBody(), poses, options);
  poses[1].root_m.x() += 0.1;
  const FrameInputs after(LoadFetchedBody(), poses, options);
  RenderJob job;
  job.frames = 2;
  job.command = "test";
  job.out = folder / "set";
  job.interrupted = [] { return true; };
  ASSERT_EQ(RenderShare(before, job), RenderEnd::kInterrupted);
  test::ExpectRefused([&] { RenderShare(after, job); },
                      "expected test or an empty folder, found what other motion or another ossa");
  job.interrupted = [] { return false; };
  EXPECT_EQ(RenderShare(before, job), RenderEnd::kDone);
}

// `ossa train` asked for a manifest, `ossa info` for a skeleton.
TEST(RenderDataset, UnfinishedDataSetIsRefusedAsSuch) {
  const test::TemporaryFolder folder;
  const fs::path set = folder / "set";
  fs::create_directories(set / ".work");
  EXPECT_FALSE(IsUnfinishedDataset(set));
  std::ofstream(set / ".work/plan.json") << "{}";
  EXPECT_TRUE(IsUnfinishedDataset(set));
  test::ExpectRefused([&] { DatasetReader reader(set); },
                      set.string() + ": the data set is not finished: expected the command");
  std::ofstream(set / "manifest.json") << "{}";
  EXPECT_FALSE(IsUnfinishedDataset(set));
}

// Killed while it writes an image, and again between the manifest and the end.
TEST(RenderDataset, RemovesLeftoversOfAKilledRun) {
  if (!recon::BodyIsFetched(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  FrameOptions options;
  options.width = 64;
  options.height = 48;
  const FrameInputs inputs(LoadFetchedBody(), MakePoseBank(recon::LoadMocap({"authored-floor"})),
                           options);
  RenderJob job;
  job.frames = 2;
  job.command = "test";
  job.out = folder / "set";
  ASSERT_EQ(RenderShare(inputs, job), RenderEnd::kDone);
  std::ofstream(folder / "set/depth/000001.png.partial-0123456789ab") << "half";
  FinishDataset(inputs, job);
  EXPECT_FALSE(fs::exists(folder / "set/depth/000001.png.partial-0123456789ab"));
  EXPECT_TRUE(fs::exists(folder / "set/depth/000001.png"));
  job.command = "another";
  test::ExpectRefused([&] { RenderShare(inputs, job); },
                      "another data set is there: expected another or an empty folder, found test");
  job.command = "test";
  fs::create_directory(folder / "set/.work");
  ASSERT_EQ(RenderShare(inputs, job), RenderEnd::kDone);
  FinishDataset(inputs, job);
  EXPECT_FALSE(fs::exists(folder / "set/.work"));
}

}  // namespace
}  // namespace ossa::tools
