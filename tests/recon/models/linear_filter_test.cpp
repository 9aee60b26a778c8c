// The learned filter of `best`: what it learns, from whom, and its file format.
#include "recon/models/linear_filter.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "recon/filters/lag_filter_internal.h"
#include "tests/recon/noisy_sensor.h"
#include "tests/support/temporary_folder.h"

namespace ossa::recon {
namespace {

constexpr size_t kHand = 7, kOtherHand = 11;

const LinearFilter& LearnedOfThree() {
  static const LinearFilter filter = LinearFilter::Learn(test::PairsOfPeople(3));
  return filter;
}

const LinearFilter& LearnedOfOne() {
  static const LinearFilter filter = LinearFilter::Learn(test::PairsOfABadSensor());
  return filter;
}

struct Error {
  double position_m = 0.0, acceleration_m = 0.0;
};

/// Mean error of one joint's way through the frames [first, first + way.size()).
Error ErrorOf(const std::vector<Eigen::Vector3d>& way, const std::vector<Posture>& truth,
              size_t first, size_t joint) {
  Error error;
  const auto off = [&](size_t k) -> Eigen::Vector3d {
    return way[k] - truth[first + k].position_m[joint];
  };
  const auto count = static_cast<double>(way.size() - 2);
  for (size_t k = 2; k < way.size(); ++k) {
    error.position_m += off(k).norm() / count;
    error.acceleration_m += (off(k) - 2.0 * off(k - 1) + off(k - 2)).norm() / count;
  }
  return error;
}

TEST(LinearFilter, ReducesDelayAndJitterOnAnotherPerson) {
  const test::SeenPerson person = test::Seen(5);
  LinearFilter::Steps steps;
  steps.fill(LinearFilter::kSteps);
  for (const size_t joint : {kHand, kOtherHand}) {
    std::array<std::vector<Eigen::Vector3d>, LinearFilter::kOutputs> made;
    std::vector<Eigen::Vector3d> seen;
    for (size_t f = LinearFilter::kSteps; f < person.seen.size(); ++f) {
      const auto window =
          std::span(person.seen).subspan(f - LinearFilter::kSteps, LinearFilter::kFrames);
      const auto estimates = LearnedOfThree().Estimate(joint, window, steps, 3.1);
      for (size_t o = 0; o < LinearFilter::kOutputs; ++o) made[o].push_back(estimates[o]);
      seen.push_back(person.seen[f].position_m[joint]);
    }
    const Error raw = ErrorOf(seen, person.truth, LinearFilter::kSteps, joint);
    const Error now = ErrorOf(made[0], person.truth, LinearFilter::kSteps, joint);
    const Error before = ErrorOf(made[1], person.truth, LinearFilter::kSteps - 1, joint);
    // Of the delay, 1 to 3 cm a frame here, next to nothing is left; of jitter of 5 mm an axis what
    // nine frames do not average.
    EXPECT_LT(now.position_m, 0.6 * raw.position_m) << joint;
    EXPECT_LT(before.position_m, 0.9 * now.position_m) << joint;
    EXPECT_LT(now.acceleration_m, 0.4 * raw.acceleration_m) << joint;
    EXPECT_LT(before.acceleration_m, now.acceleration_m) << joint;
  }
}

TEST(LinearFilter, UsesStepsForSeveralPeopleAndInfluencesForOne) {
  EXPECT_FALSE(LearnedOfThree().HasInfluences());
  EXPECT_TRUE(LearnedOfOne().Influences(LinearFilter::kNow, kHand));
  for (const auto output : {LinearFilter::kNow, LinearFilter::kBefore}) {
    for (size_t i = 0; i < kJointCount; ++i) {
      EXPECT_EQ(LearnedOfOne().Knows(output, i), LearnedOfOne().Influences(output, i)) << i;
    }
  }
}

TEST(LinearFilter, GeneralisesToAnotherPersonWithTheSameSensor) {
  const test::SeenPerson person = test::SeenBadly(5);
  LinearFilter::Steps steps;
  steps.fill(LinearFilter::kSteps);
  for (const size_t joint : {kHand, kOtherHand}) {
    std::array<double, LinearFilter::kOutputs> off_m{};
    double raw_m = 0.0, lag_m = 0.0;
    LagFilter lag;
    for (size_t f = 0; f < person.seen.size(); ++f) {
      const Eigen::Vector3d &seen = person.seen[f].position_m[joint],
                            &truth = person.truth[f].position_m[joint];
      lag.Step(seen, test::kFrame_s, 1.0);
      if (f < LinearFilter::kSteps) continue;
      const auto window =
          std::span(person.seen).subspan(f - LinearFilter::kSteps, LinearFilter::kFrames);
      const auto estimates = LearnedOfOne().Estimate(joint, window, steps, 3.1);
      const Eigen::Vector3d& before = person.truth[f - 1].position_m[joint];
      off_m[0] += (estimates[0] - truth).norm();
      off_m[1] += (estimates[1] - before).norm();
      lag_m += (lag.before_m() - before).norm();
      raw_m += (seen - truth).norm();
    }
    // Five positions average jitter of 3.5 cm to half of it; the gross error of every twentieth
    // frame, 1.5 cm of the raw mean, goes where the frame after it is known.
    EXPECT_LT(off_m[0], 0.85 * raw_m) << joint;
    EXPECT_LT(off_m[1], 0.65 * raw_m) << joint;
    EXPECT_LT(off_m[1], lag_m) << joint;
  }
}

TEST(LinearFilter, IsNotLearnedFromUnsystematicErrorsOfOnePerson) {
  auto pairs = test::PairsOfABadSensor();
  for (PosturePair& pair : pairs) pair.clip = 0, pair.time_s = 0.0;
  EXPECT_TRUE(LinearFilter::Learn(pairs).empty());
}

TEST(InfluenceFeature, HasDisplacementsWithAndWithoutDecay) {
  std::vector<Posture> window(6);
  for (size_t f = 0; f < window.size(); ++f) {
    window[f].position_m[kHand] = {0.1 * static_cast<double>(f), 1.0, 2.0};
  }
  const auto now = InfluenceFeature(window, 5, kHand, LinearFilter::kNow);
  const auto before = InfluenceFeature(window, 5, kHand, LinearFilter::kBefore);
  ASSERT_EQ(now.cols(), InfluenceFeatureSize(LinearFilter::kNow));
  ASSERT_EQ(before.cols(), InfluenceFeatureSize(LinearFilter::kBefore));
  const auto faded = [](double d, double r) { return d / (1.0 + d * d / (r * r)); };
  for (int back = 1; back <= LinearFilter::kInfluencing; ++back) {
    const double way_m = -0.1 * back;
    const Eigen::Index at = 3 * (back - 1);
    EXPECT_NEAR(now(0, at), way_m, 1e-6);
    EXPECT_NEAR(now(0, at + 1), faded(way_m, 0.05), 1e-6);
    EXPECT_NEAR(now(0, at + 2), faded(way_m, 0.15), 1e-6);
  }
  EXPECT_NEAR(before(0, 0), 0.1, 1e-6);   // the newest frame
  EXPECT_NEAR(before(0, 3), -0.1, 1e-6);  // the one before the estimated
  EXPECT_EQ(now.bottomRows(2).norm(), 0.0F);
}

TEST(InfluenceFeature, UsesKnownFramesOnly) {
  std::vector<Posture> window(6);
  for (size_t f = 0; f < window.size(); ++f) {
    window[f].position_m[kHand].x() = f < 2 ? 50.0 : 0.1 * static_cast<double>(f);
  }
  const auto feature = InfluenceFeature(window, 3, kHand, LinearFilter::kNow);
  EXPECT_NEAR(feature(0, 3 * 2), -0.3, 1e-6);
  EXPECT_NEAR(feature(0, 3 * 3), -0.3, 1e-6);  // four back is not known: three
}

TEST(LinearFilter, HasNoWeightsForJointsWithoutTruth) {
  auto pairs = test::PairsOfPeople(3);
  for (PosturePair& pair : pairs) pair.known[kHand] = pair.known[kOtherHand] = 0.0;
  const LinearFilter filter = LinearFilter::Learn(pairs);
  EXPECT_FALSE(filter.Knows(LinearFilter::kNow, kHand));
  EXPECT_TRUE(filter.Knows(LinearFilter::kNow, kHand - 1));
}

TEST(LinearFilter, DoesNotLearnFromNonConsecutiveFrames) {
  auto pairs = test::PairsOfPeople(3);
  for (size_t i = 0; i < pairs.size(); ++i) pairs[i].clip = static_cast<int>(i / 5);
  EXPECT_TRUE(LinearFilter::Learn(pairs).empty());
}

// As recorded by a program that polls faster than its sensor.
TEST(LinearFilter, DuplicatedFramesDoNotChangeWhatIsLearned) {
  std::vector<PosturePair> twice;
  for (const PosturePair& pair : test::PairsOfPeople(3)) twice.insert(twice.end(), 2, pair);
  const LinearFilter filter = LinearFilter::Learn(twice);
  EXPECT_EQ(filter.step_s, LearnedOfThree().step_s);
  for (size_t joint = 0; joint < kJointCount; ++joint) {
    EXPECT_EQ(filter.weights[LinearFilter::kNow][joint],
              LearnedOfThree().weights[LinearFilter::kNow][joint])
        << joint;
  }
}

TEST(LinearFilter, KeepsRestingJoints) {
  const std::vector<Posture> still(LinearFilter::kFrames, test::InFrontOfCamera(test::Motion(1.0)));
  LinearFilter::Steps steps;
  steps.fill(LinearFilter::kSteps);
  for (const LinearFilter* filter : {&LearnedOfThree(), &LearnedOfOne()}) {
    for (const Eigen::Vector3d& p : filter->Estimate(kHand, still, steps, 3.1)) {
      EXPECT_EQ(p, still[0].position_m[kHand]);
    }
  }
}

TEST(LinearFilter, UnreliableNeighboursDoNotMoveTheJoint) {
  const test::SeenPerson person = test::Seen(4, LinearFilter::kFrames);
  LinearFilter::Steps steps;
  steps.fill(LinearFilter::kSteps);
  steps[kHand] = -1;
  auto spoilt = person.seen;
  spoilt[4].position_m[kHand].setConstant(50.0);
  constexpr size_t kWrist = kHand - 1;
  EXPECT_EQ(LearnedOfThree().Estimate(kWrist, spoilt, steps, 3.1),
            LearnedOfThree().Estimate(kWrist, person.seen, steps, 3.1));
}

// Files hold a step of 0.001 s to 1 s.
TEST(LinearFilter, DoesNotLearnFromUnusualFrameIntervals) {
  for (const double factor : {60.0, 0.01}) {
    auto pairs = test::PairsOfPeople(3);
    for (PosturePair& pair : pairs) pair.time_s *= factor;
    EXPECT_TRUE(LinearFilter::Learn(pairs).empty()) << factor;
  }
}

class FilterFile : public testing::Test {
 protected:
  FilterFile() { models_.filter = LearnedOfThree(); }

  std::string Refusal() const {
    try {
      LearnedModels::Load(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  static constexpr std::array<char, 8> kMagic = {'O', 'S', 'S', 'A', 'G', 'P', '0', '0'};
  LearnedModels models_;
  ossa::test::TemporaryFolder folder_;  // tests run side by side
  std::filesystem::path path_ = folder_ / "filter.ossagp";
};

TEST_F(FilterFile, GivesTheSameWeightsBack) {
  for (const LinearFilter* filter : {&LearnedOfThree(), &LearnedOfOne()}) {
    models_.filter = *filter;
    models_.Save(path_);
    const LinearFilter read = LearnedModels::Load(path_).filter;
    EXPECT_EQ(read.step_s, models_.filter.step_s);
    for (size_t o = 0; o < LinearFilter::kOutputs; ++o) {
      for (size_t i = 0; i < kJointCount; ++i) {
        const Eigen::MatrixXf &made = models_.filter.weights[o][i], &back = read.weights[o][i];
        ASSERT_EQ(back.size(), made.size());
        EXPECT_TRUE(made.size() == 0 || back == made) << o << " " << i;
      }
    }
  }
}

TEST_F(FilterFile, WithoutInfluencesHasTheOlderVersion) {
  models_.Save(path_);
  EXPECT_NO_THROW(ReadContainer(path_, {kMagic, 3, "learned reconstruction"}));
  models_.filter = LearnedOfOne();
  models_.Save(path_);
  EXPECT_NO_THROW(ReadContainer(path_, {kMagic, 4, "learned reconstruction"}));
}

TEST_F(FilterFile, WithInfluencesOfTheOtherOutputIsRefused) {
  models_.filter = LearnedOfOne();
  std::swap(models_.filter.weights[0][kHand], models_.filter.weights[1][kHand]);
  models_.Save(path_);
  EXPECT_NE(Refusal().find("filter's weights"), std::string::npos) << Refusal();
}

TEST_F(FilterFile, PreviousVersionHasNoFilter) {
  models_.filter = LinearFilter();
  models_.Save(path_);
  auto payload = ReadContainer(path_, {kMagic, 3, "learned reconstruction"});
  // The step, then of two outputs and twelve joints each an empty matrix: rows, columns, count.
  payload.resize(payload.size() - (8 + 2 * 12 * 16));
  WriteContainer(path_, {kMagic, 2, "learned reconstruction"}, payload);
  EXPECT_TRUE(LearnedModels::Load(path_).filter.empty());
}

TEST_F(FilterFile, LaterVersionIsRefusedByItsNumber) {
  models_.Save(path_);
  const auto payload = ReadContainer(path_, {kMagic, 3, "learned reconstruction"});
  WriteContainer(path_, {kMagic, 6, "learned reconstruction"}, payload);
  EXPECT_NE(Refusal().find("version: expected 5, found 6"), std::string::npos) << Refusal();
}

TEST_F(FilterFile, WithWeightsOfAnotherJointIsRefused) {
  std::swap(models_.filter.weights[0][2], models_.filter.weights[0][3]);
  models_.Save(path_);
  EXPECT_NE(Refusal().find("filter's weights"), std::string::npos) << Refusal();
}

TEST_F(FilterFile, WithAStepOfNoSensorIsRefused) {
  models_.filter.step_s = -1.0;
  models_.Save(path_);
  EXPECT_NE(Refusal().find("filter's step"), std::string::npos) << Refusal();
}

}  // namespace
}  // namespace ossa::recon
