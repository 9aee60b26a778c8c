// The learned filter of `best`: what it learns, of whom, and its place in the file.
#include "recon/gp/linear_filter.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "depth/error.h"
#include "depth/file/sealed_file.h"
#include "tests/recon/noisy_sensor.h"

namespace ossa::recon {
namespace {

constexpr size_t kHand = 7, kOtherHand = 11;

const LinearFilter& LearnedOfThree() {
  static const LinearFilter filter = LinearFilter::Learn(test::PairsOfPeople(3));
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

TEST(LinearFilter, KnowsDelayAndJitterOfASensorOnSomebodyElse) {
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

TEST(LinearFilter, IsNotLearnedOfOnePersonAlone) {
  EXPECT_TRUE(LinearFilter::Learn(test::PairsOfPeople(1)).empty());
}

TEST(LinearFilter, KnowsNothingOfAJointWithoutTruth) {
  auto pairs = test::PairsOfPeople(3);
  for (PosturePair& pair : pairs) pair.known[kHand] = pair.known[kOtherHand] = 0.0;
  const LinearFilter filter = LinearFilter::Learn(pairs);
  EXPECT_FALSE(filter.Knows(LinearFilter::kNow, kHand));
  EXPECT_TRUE(filter.Knows(LinearFilter::kNow, kHand - 1));
}

TEST(LinearFilter, KnowsNothingOfFramesThatDoNotFollowEachOther) {
  auto pairs = test::PairsOfPeople(3);
  for (size_t i = 0; i < pairs.size(); ++i) pairs[i].clip = static_cast<int>(i / 5);
  EXPECT_TRUE(LinearFilter::Learn(pairs).empty());
}

TEST(LinearFilter, LeavesWhatStandsStillWhereItIs) {
  const std::vector<Posture> still(LinearFilter::kFrames, test::InFrontOfCamera(test::Motion(1.0)));
  LinearFilter::Steps steps;
  steps.fill(LinearFilter::kSteps);
  for (const Eigen::Vector3d& p : LearnedOfThree().Estimate(kHand, still, steps, 3.1)) {
    EXPECT_EQ(p, still[0].position_m[kHand]);
  }
}

TEST(LinearFilter, ANeighbourThatIsNotBelievedDoesNotMoveTheJoint) {
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

class FilterFile : public testing::Test {
 protected:
  FilterFile() { models_.filter = LearnedOfThree(); }
  ~FilterFile() override { std::filesystem::remove(path_); }

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
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / "ossa_linear_filter_test.ossagp";
};

TEST_F(FilterFile, GivesTheSameWeightsBack) {
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

TEST_F(FilterFile, OfTheVersionBeforeHasNone) {
  models_.filter = LinearFilter();
  models_.Save(path_);
  auto payload = ReadSealedFile(path_, {kMagic, 3, "learned reconstruction"});
  // The step, then of two outputs and twelve joints each an empty matrix: rows, columns, count.
  payload.resize(payload.size() - (8 + 2 * 12 * 16));
  WriteSealedFile(path_, {kMagic, 2, "learned reconstruction"}, payload);
  EXPECT_TRUE(LearnedModels::Load(path_).filter.empty());
}

TEST_F(FilterFile, OfALaterVersionIsRefusedByItsNumber) {
  models_.Save(path_);
  const auto payload = ReadSealedFile(path_, {kMagic, 3, "learned reconstruction"});
  WriteSealedFile(path_, {kMagic, 4, "learned reconstruction"}, payload);
  EXPECT_NE(Refusal().find("version: expected 3, found 4"), std::string::npos) << Refusal();
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
