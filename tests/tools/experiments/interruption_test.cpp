// Ctrl-C is checked between short steps, and ends the work there.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "recon/body/body_model.h"
#include "recon/files/skeleton_io.h"
#include "recon/motion/mocap.h"
#include "tests/recon/files/skeleton_examples.h"
#include "tests/support/temporary_folder.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {
namespace {

constexpr int kClips = 3;

void WriteClips(const std::filesystem::path& folder) {
  std::filesystem::create_directory(folder);
  for (int i = 0; i < kClips; ++i) {
    recon::WriteSkeletons(folder / (std::to_string(i) + ".jsonl"), recon::ExampleSequence(5));
  }
}

// Ctrl-C comes before the check of this number.
class CtrlC {
 public:
  explicit CtrlC(int before) : before_(before) {}
  std::function<bool()> AsQuestion() {
    return [this] { return ++asked_ > before_; };
  }
  int asked() const { return asked_; }

 private:
  int before_;
  int asked_ = 0;
};

TEST(Interruption, EndsAComparisonAtTheNextClip) {
  const test::TemporaryFolder folder;
  WriteClips(folder / "truth");
  WriteClips(folder / "result");
  const auto compare = [&](CtrlC& key) {
    CompareOptions options;
    options.stop = key.AsQuestion();
    return Compare(folder / "truth", {folder / "result", folder / "result"}, options);
  };
  CtrlC never(1000);
  EXPECT_EQ(compare(never).results.size(), 2u);
  EXPECT_GE(never.asked(), 5 * kClips) << "reading three folders, comparing two";
  for (int before = 0; before < never.asked(); ++before) {
    CtrlC key(before);
    EXPECT_THROW(compare(key), Interruption) << before;
    EXPECT_LE(key.asked(), before + 3) << "heard at once, and again by those who called";
  }
}

// One clip: most of the time is spent in the search for its clock offset.
TEST(Interruption, EndsTheSearchForAClockOffset) {
  const test::TemporaryFolder folder;
  recon::WriteSkeletons(folder / "a.jsonl", recon::ExampleSequence(90));
  CompareOptions options;
  options.pairing.time = TimeAlignment::kCorrelate;
  CtrlC never(1'000'000);
  options.stop = never.AsQuestion();
  const std::string clip = folder / "a.jsonl";
  Compare(clip, {clip}, options);
  EXPECT_GT(never.asked(), 400) << "of 2 s each way in steps of 10 ms";
  CtrlC key(100);
  options.stop = key.AsQuestion();
  EXPECT_THROW(Compare(clip, {clip}, options), Interruption);
  EXPECT_EQ(key.asked(), 101);
}

TEST(Interruption, EndsTheReadingOfRecordings) {
  const test::TemporaryFolder folder;
  WriteClips(folder / "clips");
  CtrlC key(2);
  recon::SkeletonReadOptions options;
  options.stop = key.AsQuestion();
  EXPECT_EQ(recon::ReadSkeletonClips(folder / "clips", options).size(), 2u);
  CtrlC at_once(0);
  options.stop = at_once.AsQuestion();
  EXPECT_TRUE(recon::ReadSkeletonClips(folder / "clips", options).empty());
}

TEST(Interruption, EndsTheReadingOfMocap) {
  CtrlC at_once(0);
  recon::MocapOptions options;
  options.stop = at_once.AsQuestion();
  const test::TemporaryFolder folder;
  std::ofstream(folder / "broken.bvh") << "never looked at";
  EXPECT_TRUE(recon::LoadMocap({folder.path().string()}, options).empty());
}

TEST(Interruption, EndsTheBodyStudyAtTheNextPicture) {
  if (!std::filesystem::exists(recon::BodyFolder())) GTEST_SKIP() << "no body: tools/fetch_body";
  const test::TemporaryFolder folder;
  CtrlC key(2);
  ExperimentContext context;
  context.out = folder / "out";
  context.interrupted = key.AsQuestion();
  EXPECT_THROW(RunExperiment("body", context), Interruption);
  EXPECT_EQ(key.asked(), 3) << "before each of the three views";
  CtrlC later(5);
  context.interrupted = later.AsQuestion();
  EXPECT_THROW(RunExperiment("body", context), Interruption);
  EXPECT_FALSE(std::filesystem::exists(folder / "out/motions.png"));
}

}  // namespace
}  // namespace ossa::tools
