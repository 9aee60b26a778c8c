#include "recon/fit/surface_fit.h"

#include "tests/recon/fit/posed_person.h"

namespace ossa::recon {
namespace {

bool IsFinite(const SurfaceFit& fit) {
  for (size_t j = 0; j < kJointCount; ++j) {
    if (!fit.joints_m.position_m[j].allFinite() || !fit.covariance_m2[j].allFinite()) return false;
  }
  return std::isfinite(fit.score) && fit.pose.shape.allFinite();
}

// Root mean square of the errors that the fit states for the joints.
double SaidError_m(const SurfaceFit& fit) {
  double sum = 0.0;
  for (const Eigen::Matrix3d& covariance_m2 : fit.covariance_m2) sum += covariance_m2.trace();
  return std::sqrt(sum / kJointCount);
}

constexpr int kUsualIterations = 3 + 5;  // by the options: with joints only, then with the image

SurfaceFit UsualFit() {
  const SeenSurface seen(RandomPose(1));
  return SurfaceFitter(Surface()).Fit(seen.Input(Disturbed(seen.joints_m, 0.03, 1))).value();
}

// Expectations for non-people: finite, a poor score, and at most twice the usual iterations.
void ExpectPoorButHarmless(const SurfaceFit& fit, double most_score) {
  const SurfaceFit usual = UsualFit();
  EXPECT_TRUE(IsFinite(fit));
  EXPECT_LT(fit.score, most_score);
  EXPECT_EQ(usual.iterations, kUsualIterations);
  EXPECT_LE(fit.iterations, 2 * usual.iterations);
}

// Images of the model itself: final joint errors are less than a third of the initial ones.
TEST(SurfaceFit, ConvergesFromDisturbedJoints) {
  SurfaceFitter fitter(Surface());
  double before_m = 0.0, after_m = 0.0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const SeenSurface seen(RandomPose(seed));
    const Posture start_m = Disturbed(seen.joints_m, 0.05, seed);
    const auto fit = fitter.Fit(seen.Input(start_m));
    ASSERT_TRUE(fit);
    before_m += MeanDistance_m(start_m, seen.joints_m);
    after_m += MeanDistance_m(fit->joints_m, seen.joints_m);
    EXPECT_GT(fit->explained, 0.9) << seed;
  }
  EXPECT_LT(after_m, 0.45 * before_m);
}

TEST(SurfaceFit, PlacesUnknownJointsByTheSurface) {
  const SeenSurface seen(RandomPose(3));
  Posture start_m = seen.joints_m;
  start_m[Joint::kHandLeft] += Eigen::Vector3d(0.3, 0.2, 0.0);
  SurfaceFitInput input = seen.Input(start_m);
  input.confidence[Joint::kHandLeft].reset();
  SurfaceFitter fitter(Surface());
  const auto fit = fitter.Fit(input);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->joints_m[Joint::kHandLeft] - seen.joints_m[Joint::kHandLeft]).norm(), 0.08);
}

// How much of a joint comes from the start, [0, 1].
double ShareOfStart(const SurfaceFit& fit, const Posture& start_m, size_t joint) {
  const Eigen::Vector3d& fitted_m = fit.joints_m.position_m[joint];
  return (fit.blended_m.position_m[joint] - fitted_m).norm() /
         (start_m.position_m[joint] - fitted_m).norm();
}

TEST(SurfaceFit, TrustsAMoreCertainStartMore) {
  const SeenSurface seen(RandomPose(3));
  const Posture start_m = Disturbed(seen.joints_m, 0.05, 3);
  SurfaceFitInput input = seen.Input(start_m);
  for (size_t j = 0; j < kJointCount; ++j) input.confidence[j] = j % 2 == 0 ? 1.0 : 0.2;
  input.confidence[Joint::kHead].reset();
  SurfaceFitter fitter(Surface());
  const auto fit = fitter.Fit(input);
  ASSERT_TRUE(fit);
  const double of_sure = ShareOfStart(*fit, start_m, 0);
  for (size_t j = 1; j < kJointCount; j += 2) {
    if (input.confidence[j]) {
      EXPECT_LT(ShareOfStart(*fit, start_m, j), of_sure) << j;
    }
  }
  EXPECT_EQ(fit->blended_m[Joint::kHead], fit->joints_m[Joint::kHead]);
}

TEST(SurfaceFit, TrustsAnImplausibleStartLess) {
  const SeenSurface seen(RandomPose(3));
  SurfaceFitter fitter(Surface());
  const auto share = [&](double off_m) {
    const Posture start_m = Disturbed(seen.joints_m, off_m, 3);
    SurfaceFitInput input = seen.Input(start_m);
    input.confidence.fill(1.0);
    return ShareOfStart(*fitter.Fit(input), start_m, 0);
  };
  EXPECT_GT(share(0.01), share(0.06) + 0.1);
}

TEST(SurfaceFit, IsEmptyIfTheCameraIsNotFinite) {
  SeenSurface seen(RandomPose(1));
  seen.frame.camera.fx = std::nan("");
  SurfaceFitter fitter(Surface());
  EXPECT_FALSE(fitter.Fit(seen.Input(seen.joints_m)));
}

TEST(SurfaceFit, IsIndependentOfEarlierFits) {
  const SeenSurface first(RandomPose(1)), second(RandomPose(2));
  SurfaceFitter fresh(Surface()), used(Surface());
  used.Fit(second.Input(second.joints_m));
  const auto a = fresh.Fit(first.Input(first.joints_m)), b = used.Fit(first.Input(first.joints_m));
  ASSERT_TRUE(a && b);
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(a->joints_m.position_m[j], b->joints_m.position_m[j]);
  }
}

TEST(SurfaceFit, KeepsAWellKnownShape) {
  const SurfacePose pose = RandomPose(5);
  const SeenSurface seen(pose);
  SurfaceFitInput input = seen.Input(Disturbed(seen.joints_m, 0.03, 5));
  SurfaceFitter fitter(Surface());
  const auto alone = fitter.Fit(input);
  input.shape = pose.shape;
  input.shape_frames = 100;
  const auto known = fitter.Fit(input);
  ASSERT_TRUE(alone && known);
  EXPECT_LT((known->pose.shape - pose.shape).norm(), (alone->pose.shape - pose.shape).norm());
}

TEST(SurfaceFit, IsEmptyForTenPixels) {
  const SeenSurface seen(RandomPose(1));
  SurfaceFitInput input = seen.Input(seen.joints_m);
  input.pixels = input.pixels.first(10);
  input.samples = input.samples.first(10);
  input.parts = input.parts.first(10);
  SurfaceFitter fitter(Surface());
  EXPECT_FALSE(fitter.Fit(input));
}

TEST(SurfaceFit, IsEmptyIfAJointIsNotFinite) {
  const SeenSurface seen(RandomPose(1));
  SurfaceFitInput input = seen.Input(seen.joints_m);
  input.joints_m[Joint::kHead].x() = std::nan("");
  SurfaceFitter fitter(Surface());
  EXPECT_FALSE(fitter.Fit(input));
}

TEST(SurfaceFit, WallGivesAPoorButFiniteFit) {
  SeenSurface seen(RandomPose(1));
  seen.pixels.clear();
  seen.parts.clear();
  for (int32_t p = 0; p < 320 * 240; ++p) seen.pixels.push_back(p), seen.parts.push_back(18);
  SurfaceFitter fitter(Surface());
  const auto fit = fitter.Fit(seen.Input(seen.joints_m));
  ASSERT_TRUE(fit);
  ExpectPoorButHarmless(*fit, 0.5);
  EXPECT_EQ(fit->iterations, 2 * kUsualIterations);  // a second fit was tried
  EXPECT_GT(SaidError_m(*fit), SaidError_m(UsualFit()));
}

TEST(SurfaceFit, TwoPeopleInOneMaskGiveAPoorButFiniteFit) {
  SurfacePose left = RandomPose(1), right = RandomPose(2);
  left.pelvis_m.x() = 0.5;
  right.pelvis_m.x() = -0.5;
  const SeenSurface first(left);
  SeenSurface both(right);
  for (size_t i = 0; i < first.pixels.size(); ++i) {
    const auto pixel = static_cast<size_t>(first.pixels[i]);
    both.frame.depth_mm[pixel] = std::min(both.frame.depth_mm[pixel], first.frame.depth_mm[pixel]);
    if (std::find(both.pixels.begin(), both.pixels.end(), first.pixels[i]) == both.pixels.end()) {
      both.pixels.push_back(first.pixels[i]);
      both.parts.push_back(first.parts[i]);
    }
  }
  SurfaceFitter fitter(Surface());
  const auto fit = fitter.Fit(both.Input(both.joints_m));
  ASSERT_TRUE(fit);
  ExpectPoorButHarmless(*fit, 0.9);
}

TEST(SurfaceFit, RefusesPixelsOutsideTheImage) {
  SeenSurface seen(RandomPose(1));
  seen.pixels.back() = 320 * 240;
  SurfaceFitter fitter(Surface());
  EXPECT_THROW(fitter.Fit(seen.Input(seen.joints_m)), std::invalid_argument);
}

TEST(SurfaceFitOptions, OutOfRangeValuesAreRefusedByName) {
  SurfaceFitOptions options;
  options.pixel_m = 0.0;
  try {
    options.Check();
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("pixel_m = 0"), std::string::npos);
  }
}

}  // namespace
}  // namespace ossa::recon
