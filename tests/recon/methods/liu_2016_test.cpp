#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "depth/base/error.h"
#include "recon/methods/reconstructor.h"
#include "recon/models/learned_models.h"
#include "recon/reliability.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr size_t kHand = 7, kElbow = 5;

/// Pairs of one gesture of which this joint is always seen 5 cm too low.
std::vector<PosturePair> PairsWithALow(size_t joint) {
  std::vector<PosturePair> pairs;
  for (int f = 0; f < 60; ++f) {
    PosturePair& pair = pairs.emplace_back();
    pair.observed = test::Motion(f / 10.0);
    pair.known.fill(1.0);
    pair.residual.position_m[joint].y() = 0.05;
  }
  return pairs;
}

std::shared_ptr<const LearnedModels> Learn(const std::vector<PosturePair>& pairs, int full_samples,
                                           int centres) {
  LearnOptions options;
  options.mixture.regions = 3;
  options.mixture.samples = 15;
  options.full_samples = full_samples;
  options.correction.centres = centres;
  return std::make_shared<const LearnedModels>(LearnedModels::Learn(pairs, options));
}

/// Of the left hand; of the left elbow there is no truth.
std::shared_ptr<const LearnedModels> LowHand() {
  std::vector<PosturePair> pairs = PairsWithALow(kHand);
  for (PosturePair& pair : pairs) pair.known[kElbow] = 0.0;
  return Learn(pairs, 40, 5);
}

class LearnedMethod : public testing::TestWithParam<std::string> {
 protected:
  static std::unique_ptr<Reconstructor> Make() {
    static const auto learned = LowHand();
    ReconstructorOptions options;
    options.method = GetParam();
    options.learned = learned;
    options.gaussian_process.incremental = false;
    return MakeReconstructor(options);
  }
};

TEST_P(LearnedMethod, RemovesALearnedOffset) {
  const auto method = Make();
  Posture made, truth;
  for (int f = 0; f < 30; ++f) {
    truth = test::InFrontOfCamera(test::Motion(f / 30.0));
    Posture seen = truth;
    seen.position_m[kHand].y() -= 0.05;
    made = method->Step({test::AllTracked(seen), f / 30.0, nullptr}).posture;
  }
  // Reliability asks for no offset with a quarter of the weight of the rest: 1 to 3 cm are left.
  EXPECT_LT((made.position_m[kHand] - truth.position_m[kHand]).norm(), 0.03);
}

/// Distance of the joint from its earlier observation, frame by frame, after the given frames.
std::vector<double> Strays_m(Reconstructor& method, size_t joint, TrackingState state,
                             const std::vector<double>& moved_m) {
  const Posture still = test::InFrontOfCamera(test::Gesture(0.8, 0.8, 0.5));
  std::vector<double> strays;
  Posture settled;
  for (int f = 0; f < 20 + static_cast<int>(moved_m.size()); ++f) {
    TrackedPosture seen = test::AllTracked(still);
    seen.state[joint] = state;
    if (f >= 20) seen.posture.position_m[joint].x() += moved_m[static_cast<size_t>(f - 20)];
    const Posture made = method.Step({seen, f / 30.0, nullptr}).posture;
    if (f < 20)
      settled = made;
    else
      strays.push_back((made.position_m[joint] - settled.position_m[joint]).x());
  }
  return strays;
}

// Eq. 20 extrapolates the method's own output: a joint that is neither reliable (inferred) nor
// known to the learned model has no other constraint, and one outlier would continue as motion
// forever.
TEST_P(LearnedMethod, ForgetsOneOutlier) {
  for (const size_t joint : {kHand, kElbow}) {
    for (const TrackingState state : {TrackingState::kTracked, TrackingState::kInferred}) {
      std::vector<double> moved(20, 0.0);
      moved[0] = 0.5;
      const auto strays = Strays_m(*Make(), joint, state, moved);
      for (const double stray : strays) EXPECT_LT(std::abs(stray), 0.51) << joint;
      // Poles of modulus sqrt(1/2) at most: after 12 frames 1/64 of the outlier, rung twice.
      for (size_t f = 12; f < strays.size(); ++f) EXPECT_LT(std::abs(strays[f]), 0.02) << joint;
    }
  }
}

TEST_P(LearnedMethod, SettlesAfterAJumpWithoutMuchOvershoot) {
  for (const size_t joint : {kHand, kElbow}) {
    for (const TrackingState state : {TrackingState::kTracked, TrackingState::kInferred}) {
      const auto strays = Strays_m(*Make(), joint, state, std::vector<double>(20, 0.2));
      // A step of eq. 20 with the largest temporal share, one half, overshoots by a quarter; the
      // learned offset may change by centimetres with the posture.
      for (const double stray : strays) EXPECT_LT(stray, 0.2 * 1.25 + 0.06) << joint;
      EXPECT_NEAR(strays.back(), 0.2, 0.06) << joint;
    }
  }
}

// Eq. 22 with its derivative set to zero by hand: of one joint that is fully reliable and stands
// still, y = (a mu + w_T y') / (a + w_R + w_T), with y' the offset before and a = w_S over the
// spread of eq. 9 counted in noise; no temporal term before two postures were made.
TEST(Liu2016, MinimisesTheWeightedSumOfItsThreeTerms) {
  ReconstructorOptions options;
  options.method = "liu-2016";
  options.learned = LowHand();
  options.gaussian_process.incremental = false;
  const auto method = MakeReconstructor(options);
  const Posture still = test::Motion(1.0);
  const Posture seen = test::InFrontOfCamera(still);
  const LocalMixture& mixture = options.learned->mixtures[kHand];
  const GaussianPrediction p = mixture.Predict(JointFeature(still, kHand), 9);
  const double a = std::max(0.6 / (1.0 + p.variance / p.noise), 0.2);
  double y = 0.0;
  for (int f = 0; f < 5; ++f) {
    const double temporal = f < 2 ? 0.0 : 0.2;
    y = (a * p.mean.y() + temporal * y) / (a + 0.2 + temporal);
    const Posture made = method->Step({test::AllTracked(seen), f / 30.0, nullptr}).posture;
    EXPECT_NEAR((made.position_m[kHand] - seen.position_m[kHand]).y(), y, 1e-6) << f;
  }
}

// Eqs. 20-22 written out for a moving hand that is guessed in some frames, of a larger person at
// uneven times: y = (a mu + w_T (2 M' - M'' - x)) / (a + w_R R^2 + w_T), the last step of M in
// proportion to time.
TEST(Liu2016, ContinuesTheMotionOfAPartlyReliableJoint) {
  ReconstructorOptions options;
  options.method = "liu-2016";
  options.learned = LowHand();
  options.gaussian_process.incremental = false;
  const auto method = MakeReconstructor(options);
  constexpr double kSize = 1.2;
  const Placement placement{{0.1, 0.2, 2.5}, 3.1};
  ReliabilityEstimator reliability;
  std::vector<Eigen::Vector3d> made;
  double t = 0.0, dt_before_s = 0.0;
  for (int f = 0; f < 8; ++f) {
    const double dt_s = f % 2 == 0 ? 1.0 / 32 : 1.0 / 16;
    t += dt_s;
    const Posture seen = test::Motion(t);
    TrackedPosture in_camera = test::AllTracked(Placed(Scaled(seen, kSize), placement));
    if (f % 3 == 1) in_camera.state[kHand] = TrackingState::kInferred;
    const double r = reliability.Step(in_camera, nullptr, dt_s).rate[kHand];
    const auto p = options.learned->mixtures[kHand].Predict(JointFeature(seen, kHand), 9);
    const double a = std::max(0.6 / (1.0 + p.variance / p.noise), 0.2);
    Eigen::Vector3d sum = a * p.mean;
    double total = a + 0.2 * r * r;
    if (f >= 2) {
      const Eigen::Vector3d step = made.back() - made[made.size() - 2];
      sum += 0.2 * (made.back() + dt_s / dt_before_s * step - seen.position_m[kHand]);
      total += 0.2;
    }
    const Posture result = method->Step({in_camera, t, nullptr}).posture;
    made.push_back(Normalised(result, placement).position_m[kHand] / kSize);
    EXPECT_LT((made.back() - seen.position_m[kHand] - sum / total).norm(), 1e-6) << f;
    dt_before_s = dt_s;
  }
}

// The wrist is seen 5 cm too low, the hand not at all: it stays at the corrected wrist.
TEST(Liu2016, KeepsAnAbsentHandAtItsWrist) {
  constexpr size_t kWrist = kHand - 1;
  ReconstructorOptions options;
  options.method = "liu-2016";
  options.learned = Learn(PairsWithALow(kWrist), 10, 0);
  const auto method = MakeReconstructor(options);
  for (int f = 0; f < 40; ++f) {
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Motion(f / 30.0)));
    if (f > 9) seen.state[kHand] = TrackingState::kNotTracked;
    const Posture made = method->Step({seen, f / 30.0, nullptr}).posture;
    const double hand_m = (made.position_m[kHand] - made.position_m[kWrist]).norm();
    if (f > 9) {
      EXPECT_LT(hand_m, StandardBoneLengths()[kHand] + 0.06) << f;
    }
  }
}

/// Pairs of one gesture whose left hand is seen too low by what depends on where it is.
std::shared_ptr<const LearnedModels> UnevenHand() {
  std::vector<PosturePair> pairs;
  for (int f = 0; f < 60; ++f) {
    PosturePair& pair = pairs.emplace_back();
    pair.observed = test::Motion(f / 10.0);
    pair.known.fill(1.0);
    const double noise_m = 0.004 * ((f * 7) % 5 - 2);
    pair.residual.position_m[kHand].y() =
        0.05 + 0.04 * std::sin(8.0 * pair.observed.position_m[kHand].x()) + noise_m;
  }
  LearnOptions options;
  options.mixture.regions = 3;
  options.mixture.samples = 15;
  options.full_samples = 10;
  options.correction.centres = 0;
  return std::make_shared<const LearnedModels>(LearnedModels::Learn(pairs, options));
}

/// Mean error of the hand in each second of a gesture that nothing was learned of, by a person
/// whose hand is seen where it is.
std::vector<double> HandErrors_m(const std::shared_ptr<const LearnedModels>& learned,
                                 bool incremental) {
  ReconstructorOptions options;
  options.method = "liu-2016";
  options.learned = learned;
  options.gaussian_process.incremental = incremental;
  const auto method = MakeReconstructor(options);
  std::vector<double> errors;
  for (int f = 0; f < 600; ++f) {
    const Posture truth =
        test::InFrontOfCamera(test::Gesture(2.2 + 0.3 * std::sin(f / 50.0), 0.1, 0.1));
    const Posture made = method->Step({test::AllTracked(truth), f / 30.0, nullptr}).posture;
    if (f % 30 == 0) errors.push_back(0.0);
    errors.back() += (made.position_m[kHand] - truth.position_m[kHand]).norm() / 30.0;
  }
  return errors;
}

// The learned samples are optima of eq. 22, which include reliability: predictions that are wrong
// for this person fade. Learning its own predictions would add nothing.
TEST(Liu2016, LearnsUnknownPeopleAndMovementsIncrementally) {
  const auto learned = UnevenHand();
  const auto with = HandErrors_m(learned, true), without = HandErrors_m(learned, false);
  EXPECT_NEAR(without.back(), without[5], 1e-3);  // nothing else changes with time
  EXPECT_LT(with.back(), 0.6 * with.front());
  EXPECT_LT(with.back(), 0.5 * without.back());
}

// Algorithm 2 takes samples of high reliability only.
TEST(Liu2016, LearnsNothingFromGuesses) {
  std::array<std::unique_ptr<Reconstructor>, 2> methods;
  for (const bool incremental : {false, true}) {
    ReconstructorOptions options;
    options.method = "liu-2016";
    options.learned = LowHand();
    options.gaussian_process.incremental = incremental;
    methods[incremental ? 1 : 0] = MakeReconstructor(options);
  }
  for (int f = 0; f < 60; ++f) {
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Motion(f / 30.0)));
    seen.state.fill(TrackingState::kInferred);
    const auto plain = methods[0]->Step({seen, f / 30.0, nullptr});
    const auto learning = methods[1]->Step({seen, f / 30.0, nullptr});
    ASSERT_EQ(plain.posture.position_m[kHand], learning.posture.position_m[kHand]) << f;
  }
}

std::string NameOfCase(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
}

// `ossa learn --correction-only` and the shipped file: these methods would return postures
// unchanged.
TEST_P(LearnedMethod, RefusesACorrectionOnlyFile) {
  ReconstructorOptions options;
  options.method = GetParam();
  options.learned = std::make_shared<const LearnedModels>();
  EXPECT_THROW(MakeReconstructor(options), InputError);
}

// Online samples of one person must not affect the next.
TEST(Liu2016, ForgetsTheLearnedPersonWhenReset) {
  ReconstructorOptions options;
  options.method = "liu-2016";
  options.learned = LowHand();
  const auto used = MakeReconstructor(options), fresh = MakeReconstructor(options);
  const auto step = [](Reconstructor& method, int f) {
    const Posture seen = test::InFrontOfCamera(test::Motion(f / 30.0));
    return method.Step({test::AllTracked(seen), f / 30.0, nullptr}).posture;
  };
  for (int f = 0; f < 3000; ++f) step(*used, f);
  used->Reset();
  for (int f = 0; f < 30; ++f) {
    const Posture one = step(*used, f), two = step(*fresh, f);
    for (size_t i = 0; i < kJointCount; ++i) ASSERT_EQ(one.position_m[i], two.position_m[i]) << f;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, LearnedMethod, testing::Values("liu-2016", "full-gp", "exemplar"),
                         NameOfCase);

}  // namespace
}  // namespace ossa::recon
