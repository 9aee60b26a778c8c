#include "recon/files/skeleton_writer.h"

#include <gtest/gtest.h>

#include <cctype>
#include <fstream>

#include "depth/base/atomic_file.h"
#include "recon/files/skeleton_io.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/support/full_disk.h"
#include "tests/support/refused.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

using test::FullDisk;
using test::TemporaryFolder;

std::string TextOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::filesystem::path OnlyFileIn(const std::filesystem::path& folder) {
  std::filesystem::directory_iterator only(folder);
  return only == std::filesystem::directory_iterator() ? "" : only->path();
}

class EveryFormat : public testing::TestWithParam<const char*> {
 protected:
  std::filesystem::path path() const { return folder_ / (std::string("x") + GetParam()); }
  TemporaryFolder folder_;
};

TEST_P(EveryFormat, LeavesNothingWithoutFinish) {
  {
    SkeletonWriter writer(path());
    for (const SkeletonFrame& frame : ExampleSequence(5).frames) writer.Write(frame);
    EXPECT_EQ(writer.frame_count(), 5);
  }
  EXPECT_EQ(OnlyFileIn(folder_.path()), "");
}

TEST_P(EveryFormat, IsWrittenEquallyWithAnExtensionInCapitals) {
  std::string capitals = GetParam();
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  WriteSkeletons(path(), ExampleSequence(5));
  WriteSkeletons(folder_ / ("y" + capitals), ExampleSequence(5));
  // A .trc states its own name, which is as long.
  EXPECT_EQ(std::filesystem::file_size(folder_ / ("y" + capitals)),
            std::filesystem::file_size(path()));
}

// As by a program whose clock is set back: the file is that of the other frames.
TEST_P(EveryFormat, RefusesAFrameEarlierThanTheOneBefore) {
  const SkeletonSequence sequence = ExampleSequence(6);
  WriteSkeletons(path(), sequence);
  const std::string expected = TextOf(path());
  const SkeletonFrame early = sequence.frames[2];
  SkeletonWriter writer(path());
  for (const SkeletonFrame& frame : sequence.frames) {
    writer.Write(frame);
    if (frame.frame < 3) continue;
    test::ExpectRefused([&] { writer.Write(early); },
                        "frame 2: expected times that grow, found 0.06");
  }
  writer.Finish();
  EXPECT_EQ(TextOf(path()), expected);
}

long Resident_kB() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") return (status >> word, std::stol(word));
  }
  return 0;
}

// A person's frame is two and a half kilobytes.
TEST_P(EveryFormat, NeedsMemoryIndependentOfTheLength) {
  if (test::kSanitized) GTEST_SKIP() << "memory is the sanitizer's";
  const auto frames = ExampleSequence(100).frames;
  SkeletonWriter writer(path());
  long before_kB = 0;
  for (int f = 0; f < 20000; ++f) {  // eleven minutes
    if (f == 1000) before_kB = Resident_kB();
    SkeletonFrame frame = frames[static_cast<size_t>(f) % frames.size()];
    frame.time_s = f / 30.0;
    writer.Write(frame);
  }
  EXPECT_LT(Resident_kB() - before_kB, 4000);
}

INSTANTIATE_TEST_SUITE_P(SkeletonWriter, EveryFormat,
                         testing::Values(".jsonl", ".csv", ".trc", ".bvh", ".glb"));

class LineFormats : public EveryFormat {};

// The kept file is byte for byte that of the frames that fitted.
TEST_P(LineFormats, OnAFullDiskKeepWholeFrames) {
  const auto frames = ExampleSequence(6, 2).frames;
  std::vector<std::string> whole;
  for (size_t count = 0; count <= frames.size(); ++count) {
    SkeletonSequence part{"x", {frames.begin(), frames.begin() + static_cast<long>(count)}};
    WriteSkeletons(path(), part);
    whole.push_back(TextOf(path()));
  }
  for (uint64_t room = 4000; room < whole.back().size() + 1000; room += 777) {
    std::filesystem::remove(path());
    const FullDisk disk(room);
    SkeletonWriter writer(path());
    try {
      for (const SkeletonFrame& frame : frames) writer.Write(frame);
      writer.Finish();
      EXPECT_EQ(TextOf(path()), whole.back());
    } catch (const DiskFull&) {
      const auto kept = static_cast<size_t>(writer.FinishWithWhatFits());
      EXPECT_LT(kept, frames.size());
      EXPECT_EQ(TextOf(path()), kept > 0 ? whole.at(kept) : "") << room << " bytes";
    }
  }
}

class WholeFormats : public EveryFormat {};

// Their headers need the whole recording, which is buffered on the disk that is then full: 300
// frames of a person take 150 kB there.
TEST_P(WholeFormats, OnAFullDiskKeepMostOfTheFramesThatFit) {
  SkeletonWriter writer(path());
  int64_t kept = 0;
  {
    const FullDisk disk(120000);
    try {
      for (const SkeletonFrame& frame : ExampleSequence(300, 2).frames) writer.Write(frame);
      writer.Finish();
    } catch (const DiskFull&) {
      kept = writer.FinishWithWhatFits();
    }
  }
  EXPECT_GT(kept, 60);
  EXPECT_LT(kept, 300);
  WriteSkeletons(folder_ / (std::string("expected") + GetParam()),
                 ExampleSequence(static_cast<int>(kept), 2));
  EXPECT_EQ(TextOf(path()), TextOf(folder_ / (std::string("expected") + GetParam())));
}

TEST_P(WholeFormats, OnADiskWithoutSpaceLeaveNoFile) {
  SkeletonWriter writer(path());
  for (const SkeletonFrame& frame : ExampleSequence(5, 2).frames) writer.Write(frame);
  const FullDisk disk(100);
  EXPECT_THROW(writer.Finish(), DiskFull);
  EXPECT_EQ(writer.FinishWithWhatFits(), 0);
  EXPECT_EQ(OnlyFileIn(folder_.path()), "");
}

INSTANTIATE_TEST_SUITE_P(SkeletonWriter, WholeFormats, testing::Values(".bvh", ".glb"));

// Under its temporary name, where it remains if the process is killed.
TEST_P(LineFormats, AreReadableBeforeTheyAreFinished) {
  SkeletonWriter writer(path());
  for (const SkeletonFrame& frame : ExampleSequence(7).frames) writer.Write(frame);
  EXPECT_EQ(ReadSkeletons(OnlyFileIn(folder_.path())).frames.size(), 7U);
}

INSTANTIATE_TEST_SUITE_P(SkeletonWriter, LineFormats, testing::Values(".jsonl", ".csv", ".trc"));

TEST(SkeletonWriter, ShortensNamesOfFurtherFilesIfNeeded) {
  const TemporaryFolder folder;
  const std::string name = std::string(251, 'n') + ".bvh";
  const SkeletonSequence two = ExampleSequence(5, 2);
  WriteSkeletons(folder / name, two);
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename().string());
  }
  ASSERT_EQ(names.size(), 2U);
  const std::string other = names[names[0] == name ? 1 : 0];
  EXPECT_TRUE(other.ends_with("_2.bvh")) << other;
}

// Tables start with the recording, also for people who appear later.
TEST(SkeletonWriter, LatePersonHasATableOfAllFrames) {
  const TemporaryFolder folder;
  SkeletonSequence sequence = ExampleSequence(9, 2);
  for (size_t f = 0; f < 4; ++f) sequence.frames[f].bodies.clear();
  sequence.frames[4].bodies.pop_back();
  WriteSkeletons(folder / "x.trc", sequence);
  for (const auto& [name, absent] : {std::pair("x.trc", 4U), std::pair("x_2.trc", 5U)}) {
    const SkeletonSequence back = ReadSkeletons(folder / name);
    ASSERT_EQ(back.frames.size(), 9U);
    for (size_t f = 0; f < 9; ++f) {
      const bool is_there = back.frames[f].bodies.at(0).joints[0].has_value();
      EXPECT_EQ(is_there, f >= absent) << name << " " << f;
    }
  }
}

// An SDK's unseen joint has an arbitrary position, usually the camera's; a table has no states.
TEST(SkeletonWriter, UntrackedJointsAreBlankInTables) {
  const TemporaryFolder folder;
  SkeletonSequence sequence = ExampleSequence(2);
  JointRecord& head = *sequence.frames[1].bodies[0].joints[Index(Joint::kHead)];
  head = JointRecord();
  head.state = TrackingState::kNotTracked;
  WriteSkeletons(folder / "x.trc", sequence);
  const auto back = ReadSkeletons(folder / "x.trc").frames;
  EXPECT_TRUE(back[0].bodies[0].joints[Index(Joint::kHead)]);
  EXPECT_FALSE(back[1].bodies[0].joints[Index(Joint::kHead)]);
  EXPECT_TRUE(back[1].bodies[0].joints[Index(Joint::kSpine)]);
}

TEST(SkeletonWriter, TableWithoutBodiesHasItsRows) {
  const TemporaryFolder folder;
  SkeletonSequence sequence = ExampleSequence(3);
  for (SkeletonFrame& frame : sequence.frames) frame.bodies.clear();
  WriteSkeletons(folder / "x.trc", sequence);
  EXPECT_EQ(ReadSkeletons(folder / "x.trc").frames.size(), 3U);
}

}  // namespace
}  // namespace ossa::recon
