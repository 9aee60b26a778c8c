// The filter in use: latency, threads, and long runs with sensor errors.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <thread>
#include <vector>

#include "physics/character_filter.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Posture;
using test::DancingPerson;
using test::Ground;
using test::kFrame_s;
using test::Lengths;
using test::Moved;
using test::StandingPerson;

class Latency : public testing::TestWithParam<Control> {};

TEST_P(Latency, OfTheFilterIsAtMostAFrame) {
  CharacterFilterOptions options;
  options.control = GetParam();
  options.pin_feet = false;
  CharacterFilter filter(Lengths(), options);
  // To and fro at 0.5 Hz and 1.3 m/s: a pure delay d shows as a phase of 2 pi 0.5 d.
  const double w = 2.0 * M_PI * 0.5, amplitude = 0.4;
  double in_phase = 0.0, quadrature = 0.0;
  for (int i = 0; i < 240; ++i) {
    const double t = i * kFrame_s;
    const auto out = filter.Step(Moved(StandingPerson(), {amplitude * std::sin(w * t), 0.0, 0.0}),
                                 {}, std::nullopt, kFrame_s);
    if (i < 60) continue;  // three whole periods are left
    in_phase += out.posture.position_m[0].x() * std::sin(w * t);
    quadrature -= out.posture.position_m[0].x() * std::cos(w * t);
  }
  const double delay_frames = std::atan2(quadrature, in_phase) / w / kFrame_s;
  EXPECT_LT(delay_frames, 1.0);   // wanted
  EXPECT_GT(delay_frames, -0.2);  // it does not run ahead
}

INSTANTIATE_TEST_SUITE_P(BothControls, Latency, testing::Values(Control::kPaper, Control::kMotor));

/// Mean movement of a joint between frames, metres, of a standing person seen with two
/// centimetres of noise.
double Unrest_m(double lead) {
  CharacterFilterOptions options;
  options.lead = lead;
  options.pin_feet = false;
  CharacterFilter filter(Lengths(), options);
  std::mt19937_64 random(4);
  Posture before;
  double sum_m = 0.0;
  for (int i = 0; i < 150; ++i) {
    const Posture seen = test::Shaken(StandingPerson(), 0.02, random);
    const Posture now = filter.Step(seen, {}, Ground(), kFrame_s).posture;
    for (size_t j = 0; i > 15 && j < recon::kJointCount; ++j) {
      sum_m += (now.position_m[j] - before.position_m[j]).norm() / (134 * recon::kJointCount);
    }
    before = now;
  }
  return sum_m;
}

// What removes the lag of motion does not follow noise, which goes to and fro: without that
// distinction noise would grow by 40 %.
TEST(CharacterFilter, LeadAddsLittleNoise) { EXPECT_LT(Unrest_m(1.0), 1.1 * Unrest_m(0.0)); }

std::vector<double> Dance() {
  CharacterFilter filter(Lengths());
  std::vector<double> numbers;
  for (int i = 0; i < 90; ++i) {
    const auto out = filter.Step(DancingPerson(i * kFrame_s), {}, Ground(), kFrame_s);
    for (const auto& p : out.posture.position_m) numbers.insert(numbers.end(), p.begin(), p.end());
  }
  return numbers;
}

TEST(Threads, DoNotInfluenceResults) {
  const std::vector<double> alone = Dance();
  std::vector<double> together[3];
  {
    std::vector<std::jthread> threads;
    for (auto& result : together) threads.emplace_back([&result] { result = Dance(); });
  }
  for (const auto& result : together) EXPECT_EQ(result, alone);  // every bit
}

/// A frame of a bad sensor: joints missing or displaced, or everything missing or elsewhere.
Posture Spoiled(Posture target, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto anywhere = [&] { return Vector3d(uniform(random), uniform(random), uniform(random)); };
  const double luck = uniform(random);
  for (auto& p : target.position_m) {
    p += 0.02 * anywhere();
    if (luck > 0.9 && uniform(random) > 0.0) {
      p.setConstant(std::numeric_limits<double>::quiet_NaN());
    } else if (luck < -0.95) {
      p += 3.0 * anywhere();
    } else if (luck < -0.93) {
      p.setConstant(std::numeric_limits<double>::infinity());
    }
  }
  return target;
}

// The short form of the ten hours of `ossa experiment shum-ho-2012`.
TEST(Endurance, FourMinutesOfBadInputKeepTheCharacterStable) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  CharacterFilter filter(Lengths());
  Posture before = StandingPerson();
  for (int minute = 0; minute < 24; ++minute) {
    for (int i = 0; i < 270; ++i) {
      const double dt = uniform(random) > 0.97 ? 3 * kFrame_s : kFrame_s;  // dropped frames
      const auto out = filter.Step(Spoiled(DancingPerson(i * kFrame_s), random), {}, Ground(), dt);
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        ASSERT_TRUE(out.posture.position_m[j].allFinite());
        // Bounded forces: no joint faster than 250 m/s^2 makes it in the frames of a disturbance.
        if (out.placed) continue;
        ASSERT_LT((out.posture.position_m[j] - before.position_m[j]).norm() / dt, 40.0);
      }
      before = out.posture;
    }
    for (int i = 0; i < 30; ++i) {
      before = filter.Step(StandingPerson(), {}, Ground(), kFrame_s).posture;
    }
    ASSERT_LT(test::LargestDistance(before, StandingPerson()), 0.02) << minute;
  }
}

}  // namespace
}  // namespace ossa::physics
