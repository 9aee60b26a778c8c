#include "tools/tracker/smoothing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>

#include "depth/base/error.h"

namespace ossa::tracker {
namespace {

using recon::Joint;
using recon::Posture;

Posture HeadAt(double x_m) {
  Posture posture;
  posture[Joint::kHead] = {x_m, 0, 2};
  return posture;
}

struct Preset {
  const char* name;
  double smoothing, correction, prediction, jitter_m, deviation_m;
};
void PrintTo(const Preset& preset, std::ostream* out) { *out << preset.name; }

class SdkPresets : public testing::TestWithParam<Preset> {};

// Values as published with NUI_TRANSFORM_SMOOTH_PARAMETERS in the SDK's documentation.
TEST_P(SdkPresets, HaveThePublishedValues) {
  const SmoothingOptions o = SmoothingPreset(GetParam().name);
  EXPECT_EQ(o.kind, SmoothingKind::kHolt);
  EXPECT_EQ(o.holt.smoothing, GetParam().smoothing);
  EXPECT_EQ(o.holt.correction, GetParam().correction);
  EXPECT_EQ(o.holt.prediction, GetParam().prediction);
  EXPECT_EQ(o.holt.jitter_radius_m, GetParam().jitter_m);
  EXPECT_EQ(o.holt.max_deviation_radius_m, GetParam().deviation_m);
}

INSTANTIATE_TEST_SUITE_P(SdkConformance, SdkPresets,
                         testing::Values(Preset{"default", 0.5, 0.5, 0.5, 0.05, 0.04},
                                         Preset{"smooth", 0.5, 0.1, 0.5, 0.1, 0.1},
                                         Preset{"verysmooth", 0.7, 0.3, 1.0, 1.0, 1.0}),
                         [](const auto& info) { return info.param.name; });

TEST(SdkConformance, HoltSmoothingTakesTheSdksFiveParameters) {
  // By hand: level and trend of the double exponential without jitter damping or clamping.
  SmoothingOptions o;
  o.holt = {0.5, 0.25, 2.0, 1e-9, 100};
  SmoothingState state;
  EXPECT_DOUBLE_EQ(Smooth(HeadAt(0), 0.0, o, state)[Joint::kHead].x(), 0.0);
  // Second frame: level 0.5 (0 + 1), trend 0.25 * 0.5.
  EXPECT_DOUBLE_EQ(Smooth(HeadAt(1), 0.1, o, state)[Joint::kHead].x(), 0.5 + 2 * 0.125);
  // Third: level 0.5 * 2 + 0.5 (0.5 + 0.125), trend 0.25 (level - 0.5) + 0.75 * 0.125.
  const double level = 0.5 * 2 + 0.5 * 0.625, trend = 0.25 * (level - 0.5) + 0.75 * 0.125;
  EXPECT_DOUBLE_EQ(Smooth(HeadAt(2), 0.2, o, state)[Joint::kHead].x(), level + 2 * trend);
}

// Within an endless radius of jitter nothing would ever move.
TEST(SmoothingOptions, InfiniteValuesAreRefusedUnlessTheyDisableTheFilter) {
  constexpr double kEndless = std::numeric_limits<double>::infinity();
  SmoothingOptions o;
  o.holt.max_deviation_radius_m = kEndless;  // no limit
  EXPECT_NO_THROW(o.Check());
  for (double* value :
       {&o.holt.jitter_radius_m, &o.one_euro.min_cutoff_hz, &o.one_euro.beta_per_m}) {
    const double before = std::exchange(*value, kEndless);
    EXPECT_THROW(o.Check(), std::invalid_argument);
    *value = before;
  }
}

TEST(SdkConformance, FilteredJointsStayWithinTheDeviationRadius) {
  const SmoothingOptions o = SmoothingPreset("default");
  SmoothingState state;
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    const double x_m = static_cast<double>(random() % 1000) / 500.0;
    const double off = Smooth(HeadAt(x_m), i / 30.0, o, state)[Joint::kHead].x() - x_m;
    EXPECT_LE(std::abs(off), o.holt.max_deviation_radius_m + 1e-12);
  }
}

TEST(Smoothing, ReducesTheJitterOfAStandingPerson) {
  // 8 mm of noise in each coordinate: the default leaves less than 5 mm.
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.008);
  const SmoothingOptions o = SmoothingPreset("default");
  SmoothingState state;
  double square = 0;
  for (int i = 0; i < 330; ++i) {
    const double x_m = Smooth(HeadAt(noise(random)), i / 30.0, o, state)[Joint::kHead].x();
    if (i >= 30) square += x_m * x_m / 300;
  }
  EXPECT_LT(std::sqrt(square), 0.005);
}

TEST(Smoothing, RestartsAfterAGap) {
  SmoothingState state;
  const SmoothingOptions o = SmoothingPreset("default");
  for (int i = 0; i < 10; ++i) Smooth(HeadAt(0), i / 30.0, o, state);
  EXPECT_DOUBLE_EQ(Smooth(HeadAt(3), 5.0, o, state)[Joint::kHead].x(), 3.0);
}

TEST(Smoothing, ContinuesWhenATimeRepeats) {
  for (const char* preset : {"verysmooth", "one-euro"}) {
    SmoothingState state;
    const SmoothingOptions o = SmoothingPreset(preset);
    for (int i = 0; i < 10; ++i) Smooth(HeadAt(0), i / 30.0, o, state);
    for (const double later_s : {0.0, 1e-9}) {
      SmoothingState now = state;
      EXPECT_LT(Smooth(HeadAt(0.5), 9 / 30.0 + later_s, o, now)[Joint::kHead].x(), 0.45) << preset;
    }
  }
}

TEST(Smoothing, RestartsWhenTheFilterChanges) {
  SmoothingState state;
  const SmoothingOptions holt = SmoothingPreset("verysmooth"), other = SmoothingPreset("one-euro");
  for (int i = 0; i < 10; ++i) Smooth(HeadAt(0), i / 30.0, holt, state);
  EXPECT_DOUBLE_EQ(Smooth(HeadAt(0.8), 10 / 30.0, other, state)[Joint::kHead].x(), 0.8);
  EXPECT_DOUBLE_EQ(Smooth(HeadAt(0.8), 11 / 30.0, holt, state)[Joint::kHead].x(), 0.8);
}

TEST(Smoothing, OutOfRangeValuesAreRefusedByName) {
  SmoothingOptions o;
  o.holt.smoothing = 1.0;
  try {
    o.Check();
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "SmoothingOptions.smoothing = 1.000000, must be in [0, 1)");
  }
  EXPECT_THROW(SmoothingPreset("silky"), InputError);
}

}  // namespace
}  // namespace ossa::tracker
