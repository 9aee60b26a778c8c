// Pairs of observed and true recordings, by their names.
#include "tools/learning/pair_recordings.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "depth/base/error.h"
#include "tests/recon/noisy_sensor.h"
#include "tests/support/temporary_folder.h"

namespace ossa::tools {
namespace {

class PairedFolders : public testing::Test {
 protected:
  PairedFolders() {
    for (const std::string& side : {seen_, true_}) std::filesystem::create_directory(side);
  }
  void WriteWalk(const std::string& folder, const std::string& name) const {
    recon::WriteSkeletons(folder + "/" + name + ".jsonl",
                          recon::test::SequenceOf(recon::test::Seen(1, 30).truth));
  }
  /// The pairs and the message about the files.
  size_t CountPairs() {
    said_.clear();
    const auto read = [this](const std::vector<recon::SkeletonClip>& clips) {
      for (const auto& clip : clips) {
        said_.insert(said_.end(), clip.sequence.warnings.begin(), clip.sequence.warnings.end());
      }
      return true;
    };
    PairRecordingsOptions options;
    options.clock = clock_;
    options.read = read;
    options.note = [this](const std::string& line) { said_.push_back(line); };
    return PairRecordings({seen_}, {true_}, options).size();
  }

  test::TemporaryFolder folder_;
  std::string seen_ = folder_ / "seen", true_ = folder_ / "true";
  std::vector<std::string> said_;
  PairOptions clock_{.time = TimeAlignment::kNone};
};

TEST_F(PairedFolders, ReportTheNumberOfRecordingsWithoutTruth) {
  for (const char* name : {"a", "b", "c"}) WriteWalk(seen_, name);
  for (const char* name : {"a", "B", "C"}) WriteWalk(true_, name);
  EXPECT_EQ(CountPairs(), 30u);
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find(": 2 of its 3 recordings, the first b, have none of their name in"),
            std::string::npos)
      << said_[0];
}

TEST_F(PairedFolders, OfOneRecordingEachArePairedWhateverTheNames) {
  WriteWalk(seen_, "kinect");
  WriteWalk(true_, "vicon");
  EXPECT_EQ(CountPairs(), 30u);
  EXPECT_TRUE(said_.empty());
}

// The first of the frames are left out, and the rest counted from 0.
recon::SkeletonSequence BegunLater(const std::vector<recon::Posture>& postures, int frames) {
  return recon::test::SequenceOf({postures.begin() + frames, postures.end()});
}

TEST_F(PairedFolders, WarnOfARecordingWhoseClockIsAnother) {
  const std::vector<recon::Posture> walk = recon::test::Seen(1, 300).truth;
  recon::WriteSkeletons(true_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  recon::WriteSkeletons(seen_ + "/walk.jsonl", BegunLater(walk, 24));
  CountPairs();
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("with +0.80 s added to its times"), std::string::npos) << said_[0];
}

TEST_F(PairedFolders, AreShiftedByTheSecondsGiven) {
  const std::vector<recon::Posture> walk = recon::test::Seen(1, 300).truth;
  recon::WriteSkeletons(true_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  recon::WriteSkeletons(seen_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  clock_ = {.time = TimeAlignment::kFixed, .offset_s = 0.2};
  EXPECT_EQ(CountPairs(), 294u) << "not by number: the last six frames are after the truth's end";
}

TEST_F(PairedFolders, WarnOfAWrongNumberOfSecondsByNamingTheRightOne) {
  const std::vector<recon::Posture> walk = recon::test::Seen(1, 300).truth;
  recon::WriteSkeletons(true_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  recon::WriteSkeletons(seen_ + "/walk.jsonl", BegunLater(walk, 24));
  clock_ = {.time = TimeAlignment::kFixed, .offset_s = 0.8};
  CountPairs();
  EXPECT_TRUE(said_.empty()) << said_.front();
  clock_.offset_s = 0.0;
  CountPairs();
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("check --time 0 (--time 0.80"), std::string::npos) << said_[0];
  EXPECT_EQ(said_[0].find("align them"), std::string::npos) << said_[0];
}

TEST_F(PairedFolders, WarnOfRecordingsThatAreAFrameLate) {
  const std::vector<recon::Posture> walk = recon::test::Seen(1, 900).truth;
  recon::WriteSkeletons(true_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  recon::WriteSkeletons(seen_ + "/walk.jsonl", BegunLater(walk, 1));
  CountPairs();
  ASSERT_EQ(said_.size(), 1u);
  EXPECT_NE(said_[0].find("the times are -0.033 s off the truth's, 1.0 frames"), std::string::npos)
      << said_[0];
  EXPECT_NE(said_[0].find("add --time 0.033"), std::string::npos) << said_[0];
  clock_ = {.time = TimeAlignment::kFixed, .offset_s = 0.033};
  CountPairs();
  EXPECT_TRUE(said_.empty()) << said_.front();
}

TEST_F(PairedFolders, DoNotWarnOfPartsOfAFrameOrOfNoise) {
  std::mt19937_64 rng(7);
  const std::vector<recon::Posture> walk = recon::test::Seen(1, 900).truth;
  std::vector<recon::Posture> noisy = walk;
  for (recon::Posture& posture : noisy) recon::test::AddNoise(posture, 0.02, rng);
  recon::SkeletonSequence seen = recon::test::SequenceOf(noisy);
  for (recon::SkeletonFrame& frame : seen.frames) frame.time_s += 0.01;
  recon::WriteSkeletons(true_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  recon::WriteSkeletons(seen_ + "/walk.jsonl", seen);
  CountPairs();
  EXPECT_TRUE(said_.empty()) << said_.front();
}

TEST_F(PairedFolders, AreShiftedByTheOffsetThatCorrelatesBest) {
  const std::vector<recon::Posture> walk = recon::test::Seen(1, 300).truth;
  recon::WriteSkeletons(true_ + "/walk.jsonl", recon::test::SequenceOf(walk));
  recon::WriteSkeletons(seen_ + "/walk.jsonl", BegunLater(walk, 24));
  clock_.time = TimeAlignment::kCorrelate;
  EXPECT_EQ(CountPairs(), 276u);
  ASSERT_EQ(said_.size(), 1u) << "and no warning";
  EXPECT_NE(said_[0].find("walk: +0.80"), std::string::npos) << said_[0];
}

TEST_F(PairedFolders, WithoutACommonNameAreRefused) {
  for (const char* name : {"a", "b"}) WriteWalk(seen_, name);
  WriteWalk(true_, "c");
  EXPECT_THROW(CountPairs(), InputError);
}

}  // namespace
}  // namespace ossa::tools
