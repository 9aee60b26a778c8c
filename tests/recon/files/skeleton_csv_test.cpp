// Our own table round-trips.
#include <gtest/gtest.h>

#include <limits>

#include "tests/recon/files/skeleton_examples.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

SkeletonSequence ThroughCsv(const SkeletonSequence& sequence) {
  const test::TemporaryFolder folder;
  WriteSkeletons(folder / "walk.csv", sequence);
  return ReadSkeletons(folder / "walk.csv");
}

void ExpectSameFrames(const SkeletonSequence& read, const SkeletonSequence& written) {
  ASSERT_EQ(read.frames.size(), written.frames.size());
  for (size_t f = 0; f < read.frames.size(); ++f) {
    EXPECT_EQ(read.frames[f].frame, written.frames[f].frame);
    EXPECT_NEAR(read.frames[f].time_s, written.frames[f].time_s, 1e-7);
    ASSERT_EQ(read.frames[f].bodies.size(), written.frames[f].bodies.size());
    for (size_t b = 0; b < read.frames[f].bodies.size(); ++b) {
      EXPECT_EQ(read.frames[f].bodies[b].id, written.frames[f].bodies[b].id);
    }
  }
}

// Nine significant digits do not suffice.
TEST(SkeletonCsv, KeepsSecondsSince1970) {
  SkeletonSequence sequence = ExampleSequence(10);
  for (SkeletonFrame& frame : sequence.frames) frame.time_s += 1.7e9;
  ExpectSameFrames(ThroughCsv(sequence), sequence);
}

// Equal frame numbers do not mean the same frame.
TEST(SkeletonCsv, KeepsFramesWithRepeatedNumbers) {
  SkeletonSequence sequence = ExampleSequence(60);
  for (SkeletonFrame& frame : sequence.frames) frame.frame = 0;
  ExpectSameFrames(ThroughCsv(sequence), sequence);
}

TEST(SkeletonCsv, KeepsFramesWithRepeatedNumbersAndTimes) {
  SkeletonSequence sequence = ExampleSequence(12, 2);
  for (size_t f = 0; f < 12; ++f) {
    sequence.frames[f].frame = 0;
    sequence.frames[f].time_s = static_cast<double>(f / 2);
    if (f == 8 || f == 9) sequence.frames[f].bodies.clear();
  }
  ExpectSameFrames(ThroughCsv(sequence), sequence);
}

TEST(SkeletonCsv, KeepsEveryFrameNumber) {
  SkeletonSequence sequence = ExampleSequence(4);
  sequence.frames[0].frame = std::numeric_limits<int64_t>::min();
  sequence.frames[1].frame = -3;
  sequence.frames[2].frame = int64_t{1} << 40;
  sequence.frames[3].frame = std::numeric_limits<int64_t>::max();
  ExpectSameFrames(ThroughCsv(sequence), sequence);
}

}  // namespace
}  // namespace ossa::recon
