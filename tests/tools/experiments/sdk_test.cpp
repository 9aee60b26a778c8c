// The studies of recordings with truth: chosen and fitted values never depend on the tested person.
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "tests/recon/synthetic_motion.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tools/experiments/papers/liu_2016_internal.h"
#include "tools/experiments/sdk/sdk_internal.h"

namespace ossa::tools {
namespace {

recon::SkeletonSequence SequenceOf(const std::vector<recon::Posture>& postures) {
  recon::SkeletonSequence sequence{"made up", {}};
  for (size_t f = 0; f < postures.size(); ++f) {
    recon::SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = static_cast<int64_t>(f);
    frame.time_s = static_cast<double>(f) / 30.0;
    recon::BodyRecord& body = frame.bodies.emplace_back();
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.joints[j].emplace().position_m = postures[f].position_m[j];
    }
  }
  return sequence;
}

/// One clip of a person; seen `late` frames too late and with noise.
RecordedPair Recorded(const std::string& subject, double phase_s, int late, double noise_m) {
  std::mt19937_64 rng(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<recon::Posture> truth, seen;
  for (int f = 0; f < 60; ++f) {
    const auto at = [&](int frame) {
      return recon::test::InFrontOfCamera(recon::test::Motion(phase_s + frame / 30.0));
    };
    truth.push_back(at(f));
    seen.push_back(at(f - late));
    for (auto& p : seen.back().position_m) {
      p += noise_m * Eigen::Vector3d(normal(rng), normal(rng), normal(rng));
    }
  }
  return {subject + "/clip", subject, SequenceOf(seen), SequenceOf(truth)};
}

std::vector<Fold> FoldsOf(const std::vector<RecordedPair>& people) {
  return LeaveOneSubjectOut(people, [](const RecordedPair&) { return true; });
}

TEST(Liu2016Study, LearnsFromTheOtherRecordingsWithAnyOptions) {
  test::TemporaryFolder folder;
  ExperimentContext context;
  context.out = folder.path();
  Liu2016Study study;
  study.recordings = {Recorded("a", 0.0, 1, 0.01), Recorded("b", 5.0, 0, 0.02)};
  recon::LearnOptions learn;
  learn.mixture.samples = learn.full_samples = 10;
  learn.correction.centres = 0;
  for (const auto& [tested, other] : {std::pair{0, 1}, std::pair{1, 0}}) {
    const auto at = [&](int i) { return study.recordings[static_cast<size_t>(i)]; };
    const MethodRun run = study.Run(context, "made up", "liu-2016", at(tested).subject, learn);
    EXPECT_EQ(run.options.learned_file, LearnWithout(context, {at(other)}, "", learn).string());
  }
}

// A staged recording in which nobody is found.
TEST(MethodRun, ReturnsNoFramesForAnEmptyRecording) {
  test::TemporaryFolder folder;
  ExperimentContext context;
  context.out = folder.path();
  MethodRun run{"raw", {}, {}};
  run.options.method = "none";
  const auto pairs = RunOverClips(context, run, {RecordedPair{}});
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_TRUE(pairs[0].time_s.empty());
  EXPECT_EQ(Average(MeasureAll(pairs), &ClipMetrics::parent_relative_error_cm), std::nullopt);
}

TEST(Hardest, ListsGroupsWhereTheLastMethodIsFarOffSeparately) {
  const auto clip = [](const char* name, double cm) {
    ClipMetrics metrics;
    metrics.name = name;
    metrics.parent_relative_error_cm = cm;
    return metrics;
  };
  const std::vector<MethodScore> scores = {
      {"raw",
       {clip("a/m1_e1", 9.0), clip("a/m1_e2", 10.0), clip("a/m2_e1", 40.0), clip("b/m1_e1", 2.0)},
       0.0},
      {"best",
       {clip("a/m1_e1", 11.0), clip("a/m1_e2", 12.0), clip("a/m2_e1", 3.0), clip("b/m1_e1", 1.0)},
       0.0}};
  const Table table = HardestTable("made up", scores);
  const std::vector<std::vector<std::string>> expected = {{"a", "m1", "2", "9.50", "11.50"},
                                                          {"all others", "", "2", "21.00", "2.00"}};
  EXPECT_EQ(table.rows, expected);
}

TEST(LinearBound, RemovesADelayOfOneFrame) {
  const std::vector<RecordedPair> people = {Recorded("a", 0.0, 1, 0.0), Recorded("b", 5.0, 1, 0.0)};
  Table table;
  AddLinearBound("made up", FoldsOf(people), &table);
  const double raw_cm =
      *Measure(PairUp(people[0].truth, people[0].observed)[0]).mean_joint_error_cm;
  // What was seen a frame later is the truth; only the clip's last frame of 60 has none. The table
  // is rounded to a tenth of a millimetre.
  EXPECT_LT(std::stod(table.rows[0][3]), raw_cm / 60.0 + 0.02);
}

TEST(Itop, BestLearnedOnHalfARecordingBeatsOneEuroOnTheOtherHalf) {
  if (!std::filesystem::exists(test::SharedFolder() / "real/itop_a2j"))
    GTEST_SKIP() << "no recordings";
  const auto whole = LoadItop(test::SharedFolder()).at(0);
  const size_t frames = whole.observed.frames.size();
  const std::vector<RecordedPair> halves = {Part(whole, 0, frames / 2, "first"),
                                            Part(whole, frames / 2, frames, "second")};
  for (const Fold& fold : FoldsOf(halves)) {
    const auto error_cm = [&](const std::string& method) {
      const FoldScore score = TestFold(fold, method, LearnFold(fold, method, {}), 1);
      return *score.clips.at(0).mean_joint_error_cm;
    };
    EXPECT_LT(error_cm("best"), error_cm("one-euro") - 0.05) << fold.name;
  }
}

TEST(Nested, ChosenConstantsDoNotDependOnTheTestedPerson) {
  const test::TemporaryFolder folder;
  ExperimentContext context;
  context.out = folder.path();
  const auto chosen = [&](double noise_of_c_m) {
    const std::vector<RecordedPair> people = {Recorded("a", 0.0, 0, 0.01),
                                              Recorded("b", 5.0, 0, 0.01),
                                              Recorded("c", 9.0, 0, noise_of_c_m)};
    context.out = folder.path() / std::to_string(noise_of_c_m);
    std::filesystem::create_directories(context.out);
    Table methods;
    const Table table = RunNested(context, "made up", FoldsOf(people), {}, &methods);
    EXPECT_EQ(methods.rows.size(), 1U);
    EXPECT_EQ(table.rows.size(), 3U);
    return std::vector<std::string>(table.rows[2].begin(), table.rows[2].end() - 2);
  };
  EXPECT_EQ(chosen(0.002), chosen(0.1));
}

}  // namespace
}  // namespace ossa::tools
