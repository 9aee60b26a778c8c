// Skeleton files written through the C interface.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "recon/files/skeleton_io.h"
#include "tests/support/full_disk.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/tracker/walk_in_c.h"

namespace ossa::tracker {
namespace {

using test::PlainOptionsInC;
using test::Says;
using test::Sized;
using test::WalkInC;

/// Writes a walk of that many frames.
ossa_status WriteWalk(const std::string& path, int frames, ossa_options options = PlainOptionsInC(),
                      const ossa_writer_options* how = nullptr) {
  WalkInC walk(options);
  ossa_writer* writer = ossa_writer_open(path.c_str(), how);
  EXPECT_NE(writer, nullptr) << ossa_last_error();
  for (int i = 0; i < frames; ++i) {
    walk.Next();
    ossa_writer_write(writer, walk.tracker);
  }
  const ossa_status status = ossa_writer_finish(writer);
  ossa_writer_close(writer);
  return status;
}

TEST(CInterface, WriterWritesSkeletons) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.jsonl";
  ASSERT_EQ(WriteWalk(path, 3), OSSA_OK) << ossa_last_error();
  const recon::SkeletonSequence read = recon::ReadSkeletons(path);
  ASSERT_EQ(read.frames.size(), 3U);
  EXPECT_EQ(read.frames[2].frame, 2);
  ASSERT_EQ(read.frames[2].bodies.size(), 1U);
  EXPECT_TRUE(read.frames[2].bodies[0].joints[recon::Joint::kFootLeft]);
  WalkInC walk;
  EXPECT_NEAR(read.frames[0].bodies[0].joints[recon::Joint::kHead]->position_m.z(),
              walk.Next().joints[OSSA_HEAD].position_m[2], 1e-3);
}

// Joints that are not tracked in seated mode are not written, as by `ossa track --mode seated`.
TEST(CInterface, WriterWritesTheUpperJointsOfSeatedPeople) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.jsonl";
  ossa_options options = PlainOptionsInC();
  options.seated = 1;
  ASSERT_EQ(WriteWalk(path, 1, options), OSSA_OK) << ossa_last_error();
  const auto joints = recon::ReadSkeletons(path).frames.at(0).bodies.at(0).joints;
  EXPECT_TRUE(joints[recon::Joint::kHead]);
  EXPECT_FALSE(joints[recon::Joint::kFootLeft]);
}

TEST(CInterface, WriterAddsAMeshToAGlbUnlessDisabled) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string dressed = folder / "dressed.glb", bare = folder / "bare.glb";
  auto how = Sized<ossa_writer_options>();
  ASSERT_EQ(WriteWalk(dressed, 2), OSSA_OK) << ossa_last_error();
  how.mesh = "none";
  how.names = "mixamo";
  ASSERT_EQ(WriteWalk(bare, 2, PlainOptionsInC(), &how), OSSA_OK) << ossa_last_error();
  EXPECT_GT(std::filesystem::file_size(dressed), 2 * std::filesystem::file_size(bare));
}

TEST(CInterface, WriterErrorsHaveMessages) {
  const test::TemporaryFolder folder;
  auto how = Sized<ossa_writer_options>();
  const auto refuses = [&](const char* name, const char* what) {
    const std::string path = folder / name;
    EXPECT_EQ(ossa_writer_open(path.c_str(), &how), nullptr) << name;
    EXPECT_TRUE(Says(what)) << ossa_last_error();
  };
  refuses("x.txt", "x.txt");
  how.posture = "best";
  refuses("x.jsonl",
          "posture: expected final, reconstructed, fitted, refined or raw, found 'best'");
  how.posture = nullptr;
  how.names = "sdk";
  refuses("x.glb", "names: expected cmu, mixamo or vrm, found 'sdk'");
  how.names = "vrm";
  refuses("x.csv", "names: expected a .bvh or .glb with them");
  how.names = nullptr;
  how.mesh = "none";
  refuses("x.bvh", "mesh: expected a .glb with them");
  how.mesh = nullptr;
  how.surface = "mine.ossasurface";
  refuses("x.glb", "surface: expected its skin with it");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(CInterface, UnfinishedWriterLeavesNothingAndAFinishedOneRefusesFrames) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.csv";
  WalkInC walk;
  walk.Next();
  ossa_writer* writer = ossa_writer_open(path.c_str(), nullptr);
  EXPECT_EQ(ossa_writer_write(writer, walk.tracker), OSSA_OK) << ossa_last_error();
  ossa_writer_close(writer);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  writer = ossa_writer_open(path.c_str(), nullptr);
  EXPECT_EQ(ossa_writer_write(writer, walk.tracker), OSSA_OK);
  EXPECT_EQ(ossa_writer_finish(writer), OSSA_OK) << ossa_last_error();
  EXPECT_EQ(ossa_writer_write(writer, walk.tracker), OSSA_FAILED);
  EXPECT_EQ(ossa_writer_finish(writer), OSSA_FAILED);
  EXPECT_TRUE(Says("expected a writer that is not finished")) << ossa_last_error();
  ossa_writer_close(writer);
  EXPECT_TRUE(std::filesystem::exists(path));
}

TEST(CInterface, WriterKeepsTheFramesThatFitOnAFullDisk) {
  OSSA_NEEDS_MODEL();
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.jsonl";
  {
    const test::FullDisk disk(30000);  // bytes; a frame has some 4 000
    EXPECT_EQ(WriteWalk(path, 12), OSSA_FAILED);
  }
  EXPECT_TRUE(Says("frames were kept")) << ossa_last_error();
  const size_t kept = recon::ReadSkeletons(path).frames.size();
  EXPECT_GT(kept, 2U);
  EXPECT_LT(kept, 12U);
}

}  // namespace
}  // namespace ossa::tracker
