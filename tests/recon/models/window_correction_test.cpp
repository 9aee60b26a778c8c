#include "recon/models/window_correction.h"

#include <gtest/gtest.h>

#include <random>

#include "depth/base/train_interrupted.h"
#include "recon/models/learned_models.h"
#include "recon/models/pose_correction.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;
constexpr size_t kHand = 7;
constexpr int kPeople = 4, kFramesEach = 600;

/// The output of a sensor with latency, and the truth; or random errors.
PosturePair PairAt(double time_s, double late_s, std::mt19937_64* noise) {
  PosturePair pair;
  pair.known.fill(1.0);
  pair.time_s = time_s;
  pair.observed = test::Motion(time_s - late_s);
  const Posture truth = test::Motion(time_s);
  std::normal_distribution<double> normal(0.0, 0.05);
  for (size_t j = 0; j < kJointCount; ++j) {
    pair.residual.position_m[j] = truth.position_m[j] - pair.observed.position_m[j];
    if (noise != nullptr) pair.residual.position_m[j] = {normal(*noise), normal(*noise), 0.0};
  }
  return pair;
}

std::vector<PosturePair> MakePairs(double late_s, bool random, int people = kPeople) {
  std::mt19937_64 noise(5);
  std::vector<PosturePair> pairs;
  for (int f = 0; f < kPeople * kFramesEach; ++f) {
    // Everybody moves from another moment on.
    const int person = f / kFramesEach;
    pairs.push_back(PairAt(40.0 * person + f * kFrame_s, late_s, random ? &noise : nullptr));
    pairs.back().clip = person * kFramesEach;
    pairs.back().group = person % people;
  }
  return pairs;
}

WindowCorrectionOptions Quick() {
  WindowCorrectionOptions options;
  options.hidden = 64;
  return options;
}

/// Ratio of the left hand's mean error with correction to that without, for an unseen person.
double ErrorLeftOf(const WindowCorrection& correction, double late_s) {
  FeatureHistory history;
  double before_m = 0.0, after_m = 0.0;
  for (int f = 0; f < 300; ++f) {
    const PosturePair pair = PairAt(1000.0 + f * kFrame_s, late_s, nullptr);
    const Eigen::VectorXf feature = CorrectionFeature(pair.observed);
    const Posture offsets = correction.Offsets(history.WindowAt(pair.time_s, feature));
    history.Add(pair.time_s, feature);
    before_m += pair.residual.position_m[kHand].norm();
    after_m += (pair.residual.position_m[kHand] - offsets.position_m[kHand]).norm();
  }
  return after_m / before_m;
}

TEST(WindowCorrection, CorrectsADelayFromPastMotion) {
  const auto correction = WindowCorrection::Learn(MakePairs(0.1, false), Quick());
  ASSERT_FALSE(correction.empty());
  EXPECT_LT(ErrorLeftOf(correction, 0.1), 0.5);
}

TEST(WindowCorrection, IgnoresUnsystematicErrors) {
  const auto correction = WindowCorrection::Learn(MakePairs(0.0, true), Quick());
  for (const double gain : correction.gains) EXPECT_EQ(gain, 0.0);
}

TEST(WindowCorrection, IsNotLearnedFromOnePerson) {
  EXPECT_TRUE(WindowCorrection::Learn(MakePairs(0.1, false, 1), Quick()).empty());
}

// Training takes a minute; Ctrl-C must stop it earlier.
TEST(LearnedModels, LearningCanBeStopped) {
  const std::vector<PosturePair> pairs = MakePairs(0.1, false);
  PoseCorrectionOptions pose;
  WindowCorrectionOptions window = Quick();
  pose.stop = window.stop = [] { return true; };
  EXPECT_THROW(PoseCorrection::Learn(pairs, pose), TrainInterrupted);
  EXPECT_THROW(WindowCorrection::Learn(pairs, window), TrainInterrupted);
}

TEST(WindowCorrection, SurvivesAFile) {
  LearnedModels models;
  models.window = WindowCorrection::Learn(MakePairs(0.1, false), Quick());
  const ossa::test::TemporaryFolder folder;
  models.Save(folder.path() / "window.ossagp");
  const LearnedModels read = LearnedModels::Load(folder.path() / "window.ossagp");
  ASSERT_FALSE(read.window.empty());
  const Eigen::VectorXf now = CorrectionFeature(test::Motion(0.3));
  const Eigen::VectorXf window = FeatureHistory().WindowAt(0.0, now);
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(models.window.Offsets(window).position_m[j],
              read.window.Offsets(window).position_m[j]);
  }
}

TEST(FeatureHistory, TakesTheSampleNearestInTimeForEachLag) {
  FeatureHistory history;
  const auto feature = [](float value) { return Eigen::VectorXf::Constant(1, value); };
  for (int f = 0; f < 10; ++f) history.Add(0.07 * f, feature(static_cast<float>(f)));
  const Eigen::VectorXf window = history.WindowAt(0.7, feature(10.0F));
  EXPECT_EQ(window[0], 10.0F);
  EXPECT_EQ(window[1], 9.0F);
  EXPECT_EQ(window[2], 8.0F);
  EXPECT_EQ(window[3], 6.0F);  // 0.27 s before: 0.42 s
  EXPECT_EQ(window[4], 2.0F);  // 0.54 s before: 0.14 s
}

// Loggers poll faster than the sensor delivers; only a large step back is another recording.
TEST(FeatureHistory, RepeatedTimeReplacesTheSample) {
  FeatureHistory history;
  const auto feature = [](float value) { return Eigen::VectorXf::Constant(1, value); };
  for (int f = 0; f < 10; ++f) {
    for (int i = 0; i < 2; ++i) history.Add(0.07 * f, feature(static_cast<float>(f)));
  }
  EXPECT_EQ(history.WindowAt(0.7, feature(10.0F))[4], 2.0F);  // 0.54 s before: 0.14 s
  history.Add(0.0, feature(20.0F));
  EXPECT_EQ(history.WindowAt(0.6, feature(10.0F))[4], 20.0F);
}

TEST(FeatureHistory, OfASingleFrameIsThatFrameAtEveryLag) {
  const Eigen::VectorXf now = Eigen::VectorXf::Constant(2, 3.0F);
  EXPECT_TRUE((FeatureHistory().WindowAt(5.0, now).array() == 3.0F).all());
}

}  // namespace
}  // namespace ossa::recon
