// The method `best` with a posture prior: what is hidden, and the bad inputs it must come through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/methods/reconstructor.h"
#include "recon/models/posture_prior.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr double kStep_s = 1.0 / 30.0;

std::unique_ptr<Reconstructor> MakeBestOne(bool with_prior = true) {
  static const auto prior = [] {
    PriorClip clip;
    for (double t = 0.0; t < 300.0; t += kStep_s) clip.postures.push_back(test::Motion(t));
    return std::make_shared<const PosturePrior>(PosturePrior::Learn({clip}));
  }();
  ReconstructorOptions options;
  if (with_prior) options.prior = prior;
  return MakeReconstructor(options);
}

Posture At(double time_s, double scale = 1.0) {
  return test::InFrontOfCamera(test::Motion(time_s), scale);
}

TrackedPosture Without(const Posture& posture, const std::vector<size_t>& hidden) {
  TrackedPosture observed = test::AllTracked(posture);
  for (const size_t joint : hidden) observed.state[joint] = TrackingState::kNotTracked;
  return observed;
}

/// Mean error of a joint over two seconds in which some joints are hidden, after a second and a
/// half in which none was.
double Error_m(Reconstructor& method, const std::vector<size_t>& hidden, size_t measured,
               double scale = 1.0) {
  double t = 0.0, sum_m = 0.0;
  for (; t < 1.5; t += kStep_s) method.Step({test::AllTracked(At(t, scale)), t, nullptr});
  constexpr int kFrames = 60;
  for (int f = 0; f < kFrames; ++f, t += kStep_s) {
    const auto made = method.Step({Without(At(t, scale), hidden), t, nullptr});
    sum_m += (made.posture.position_m[measured] - At(t, scale).position_m[measured]).norm();
  }
  return sum_m / kFrames;
}

TEST(BestWithPrior, MovesAHiddenLegWithTheOtherAndKeepsVisibleJoints) {
  const std::vector<size_t> leg = {17, 18, 19};
  const auto held = MakeBestOne(false), expected = MakeBestOne();
  const double off_m = Error_m(*expected, leg, 17);
  // The knees swing together, as in all that was learned from.
  EXPECT_LT(off_m, 0.3 * Error_m(*held, leg, 17));
  const auto again = MakeBestOne();
  EXPECT_LT(Error_m(*again, leg, 6), 0.02);
}

TEST(BestWithPrior, CompletesChildrenAndTallPeople) {
  for (const double scale : {0.9 / 1.66, 2.2 / 1.66}) {
    const auto method = MakeBestOne();
    EXPECT_LT(Error_m(*method, {17, 18, 19}, 17, scale), 0.05 * scale) << scale;
  }
}

TEST(BestWithPrior, CompletesThePostureFromHandsAndFeetAlone) {
  // Setup (c) of Shum 2013 table III: fewer joints than a database needs.
  std::vector<size_t> hidden;
  for (size_t i = 1; i < kJointCount; ++i) {
    if (i != 7 && i != 11 && i != 15 && i != 19) hidden.push_back(i);
  }
  const auto held = MakeBestOne(false), expected = MakeBestOne();
  EXPECT_LT(Error_m(*expected, hidden, 5), 0.5 * Error_m(*held, hidden, 5));
}

TEST(BestWithPrior, IsEquivariantUnderMirroring) {
  const auto mirrored = [](const TrackedPosture& seen) {
    TrackedPosture out = seen;
    for (size_t i = 0; i < kJointCount; ++i) {
      const auto other = kMirroredJoint[i];
      out.posture.position_m[i] = seen.posture.position_m[other];
      out.posture.position_m[i].x() *= -1.0;
      out.state[i] = seen.state[other];
    }
    return out;
  };
  const auto one = MakeBestOne(), other = MakeBestOne();
  for (int f = 0; f < 60; ++f) {
    const std::vector<size_t> hidden =
        f > 40 ? std::vector<size_t>{4, 5, 6, 7, 19} : std::vector<size_t>{};
    const double t = f * kStep_s;
    const TrackedPosture seen = Without(At(t), hidden);
    TrackedPosture made;
    made.posture = one->Step({seen, t, nullptr}).posture;
    const Posture of_mirrored = other->Step({mirrored(seen), t, nullptr}).posture;
    EXPECT_LT(test::MeanDistance_m(mirrored(made).posture, of_mirrored), 1e-5) << f;
  }
}

TEST(BestWithPrior, IsFiniteForAnyInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const size_t seen : {0U, 1U, 2U, 5U}) {
    const auto method = MakeBestOne();
    for (int f = 0; f < 40; ++f) {
      TrackedPosture observed = test::AllTracked(At(f * kStep_s));
      if (f % 20 >= 5) {
        for (size_t i = seen; i < kJointCount; ++i) observed.posture.position_m[i].setConstant(nan);
      }
      const double t = f * kStep_s + (f > 25 ? 9.0 : 0.0);
      const Posture made = method->Step({observed, t, nullptr}).posture;
      for (const auto& p : made.position_m) {
        ASSERT_TRUE(p.allFinite()) << seen << " " << f;
        EXPECT_LT((p - made.position_m[0]).norm(), 2.0);
      }
    }
  }
}

TEST(BestWithPrior, KeepsThePostureWhileAllJointsAreMissing) {
  const auto method = MakeBestOne();
  double t = 0.0;
  for (; t < 1.5; t += kStep_s) method->Step({test::AllTracked(At(t)), t, nullptr});
  for (int f = 0; f < 6; ++f) {
    const auto made = method->Step({TrackedPosture(), t + f * kStep_s, nullptr});
    EXPECT_LT(test::MeanDistance_m(made.posture, At(t - kStep_s)), 0.1) << f;
  }
}

}  // namespace
}  // namespace ossa::recon
