#include "physics/character_filter.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "depth/base/error.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Posture;
using test::DancingPerson;
using test::Ground;
using test::kFrame_s;
using test::LargestDistance;
using test::LargestLengthError;
using test::Lengths;
using test::Moved;
using test::StandingPerson;

const double kNaN = std::numeric_limits<double>::quiet_NaN();

bool AllFinite(const FilteredPosture& f) {
  for (size_t i = 0; i < recon::kJointCount; ++i) {
    if (!f.posture.position_m[i].allFinite()) return false;
    if (std::abs(f.orientation[i].norm() - 1.0) > 1e-9) return false;
  }
  return true;
}

TEST(CharacterFilter, SettlesOnASteadyTarget) {
  CharacterFilter filter(Lengths());
  filter.Step(Moved(StandingPerson(), {0.02, 0.0, 0.02}), {}, Ground(), kFrame_s);
  FilteredPosture out;
  for (int i = 0; i < 60; ++i) out = filter.Step(StandingPerson(), {}, Ground(), kFrame_s);
  // What is left are contact and solver residues: a millimetre.
  EXPECT_LT(LargestDistance(out.posture, StandingPerson()), 0.003);
}

class FilterBounds : public testing::TestWithParam<Control> {};

TEST_P(FilterBounds, KeepsLengthsAnchorsAndFloorWhileDancing) {
  CharacterFilterOptions options;
  options.control = GetParam();
  CharacterFilter filter(Lengths(), options);
  double length_error = 0.0, gap = 0.0, solver_gap = 0.0, depth = 0.0;
  for (int i = 0; i < 300; ++i) {
    const auto out = filter.Step(DancingPerson(i * kFrame_s), {}, Ground(), kFrame_s);
    ASSERT_TRUE(AllFinite(out)) << "frame " << i;
    length_error = std::max(length_error, LargestLengthError(out.posture));
    gap = std::max(gap, out.max_anchor_gap_m);
    solver_gap = std::max(solver_gap, out.max_solver_gap_m);
    depth = std::max(depth, out.floor_depth_m);
  }
  EXPECT_LT(length_error, 1e-3);  // wanted; by construction it is rounding
  EXPECT_LT(gap, 0.5e-3);         // wanted
  EXPECT_LT(solver_gap, 0.5e-3);  // before the bodies are reconnected, too
  EXPECT_LT(depth, 0.005);        // wanted
}

INSTANTIATE_TEST_SUITE_P(BothControls, FilterBounds,
                         testing::Values(Control::kPaper, Control::kMotor));

TEST(CharacterFilter, GivesTheSameBytesEachRun) {
  const auto run = [] {
    CharacterFilter filter(Lengths());
    std::vector<double> bytes;
    for (int i = 0; i < 60; ++i) {
      const auto out = filter.Step(DancingPerson(i * kFrame_s), {}, Ground(), kFrame_s);
      for (size_t j = 0; j < recon::kJointCount; ++j) {
        for (const double v : out.posture.position_m[j]) bytes.push_back(v);
        for (const double v : out.orientation[j].coeffs()) bytes.push_back(v);
      }
    }
    return bytes;
  };
  const auto a = run(), b = run();
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(0, std::memcmp(a.data(), b.data(), a.size() * sizeof(double)));
}

/// Bad targets that sensors do give.
struct BadTarget {
  const char* name;
  Posture (*make)(int frame);
};

class BadTargets : public testing::TestWithParam<BadTarget> {};

TEST_P(BadTargets, StaysFiniteAndRecoversWithinASecond) {
  CharacterFilter filter(Lengths());
  for (int i = 0; i < 30; ++i) filter.Step(StandingPerson(), {}, Ground(), kFrame_s);
  FilteredPosture out, before;
  for (int i = 0; i < 60; ++i) {
    out = filter.Step(GetParam().make(i), {}, Ground(), kFrame_s);
    ASSERT_TRUE(AllFinite(out)) << i;
    // Bounded forces: a joint reaches no speed that 250 m/s^2 do not give it in these frames.
    if (i > 0 && !out.placed) {
      ASSERT_LT(LargestDistance(out.posture, before.posture), 40.0 * kFrame_s) << i;
    }
    before = out;
  }
  for (int i = 0; i < 30; ++i) {
    out = filter.Step(StandingPerson(), {}, Ground(), kFrame_s);
    ASSERT_TRUE(AllFinite(out)) << i;
  }
  EXPECT_LT(LargestDistance(out.posture, StandingPerson()), 0.01);
}

Posture AllNaN(int) {
  Posture p;
  p.position_m.fill(Vector3d::Constant(kNaN));
  return p;
}
Posture SomeNaN(int frame) {
  Posture p = DancingPerson(frame * kFrame_s);
  for (size_t i = 0; i < recon::kJointCount; ++i) {
    if ((static_cast<size_t>(frame) + i) % 3 == 0) p.position_m[i].setConstant(kNaN);
  }
  return p;
}
Posture Teleporting(int frame) {
  return Moved(StandingPerson(), {frame % 2 == 0 ? 3.0 : -3.0, 0.0, 0.0});
}
Posture UpsideDown(int) {
  Posture p = StandingPerson();
  for (auto& v : p.position_m) v = Vector3d(v.x(), 1.7 - v.y(), -v.z());
  return p;
}
Posture UnderTheFloor(int) { return Moved(StandingPerson(), {0.0, -1.2, 0.0}); }
Posture Huge(int) { return Moved(StandingPerson(), {1e30, -1e300, 1e9}); }
Posture Collapsed(int) { return Posture(); }
Posture Mirrored(int frame) {
  Posture p = StandingPerson();
  if (frame % 2 == 0) return p;
  Posture m;
  for (size_t i = 0; i < recon::kJointCount; ++i) {
    m.position_m[i] = p.position_m[recon::kMirroredJoint[i]];
  }
  return m;
}

INSTANTIATE_TEST_SUITE_P(Nasty, BadTargets,
                         testing::Values(BadTarget{"AllNaN", AllNaN}, BadTarget{"SomeNaN", SomeNaN},
                                         BadTarget{"Teleporting", Teleporting},
                                         BadTarget{"UpsideDown", UpsideDown},
                                         BadTarget{"UnderTheFloor", UnderTheFloor},
                                         BadTarget{"Huge", Huge}, BadTarget{"Collapsed", Collapsed},
                                         BadTarget{"Mirrored", Mirrored}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(CharacterFilter, JointsOfWeightZeroCountAsMissing) {
  CharacterFilter filter(Lengths());
  filter.Step(StandingPerson(), {}, Ground(), kFrame_s);
  recon::JointArray<double> weight;
  weight.fill(1.0);
  Posture target = StandingPerson();
  for (const size_t joint : {5U, 6U, 7U}) {
    weight[joint] = 0.0;
    target.position_m[joint].setConstant(50.0);
  }
  FilteredPosture out;
  for (int i = 0; i < 30; ++i) out = filter.Step(target, weight, Ground(), kFrame_s);
  EXPECT_LT(LargestDistance(out.posture, StandingPerson()), 0.03);  // the arm hangs as it hung
}

class FrameRates : public testing::TestWithParam<std::tuple<double, Control>> {};

TEST_P(FrameRates, FollowAJumpWithoutOvershoot) {
  const double dt = 1.0 / std::get<double>(GetParam());
  CharacterFilterOptions options;
  options.control = std::get<Control>(GetParam());
  options.pin_feet = false;
  CharacterFilter filter(Lengths(), options);
  filter.Step(StandingPerson(), {}, std::nullopt, dt);
  const Posture goal = Moved(StandingPerson(), {0.3, 0.0, 0.0});
  double overshoot = 0.0;
  FilteredPosture out;
  for (double t = 0.0; t < 1.0; t += dt) {
    out = filter.Step(goal, {}, std::nullopt, dt);
    overshoot = std::max(overshoot, out.posture.position_m[0].x() - goal.position_m[0].x());
  }
  // Servos in a chain are solved iteratively: a leg that hangs free is left 1-2 cm off.
  const bool motors = options.control == Control::kMotor;
  EXPECT_LT(LargestDistance(out.posture, goal), motors ? 0.03 : 0.001);
  EXPECT_LT(overshoot, 0.005);  // critically damped; the bound on forces costs a little
}

INSTANTIATE_TEST_SUITE_P(Hertz, FrameRates,
                         testing::Combine(testing::Values(15.0, 24.0, 30.0, 60.0, 120.0),
                                          testing::Values(Control::kPaper, Control::kMotor)));

TEST(CharacterFilter, RestartsAfterAGap) {
  CharacterFilter filter(Lengths());
  EXPECT_TRUE(filter.Step(StandingPerson(), {}, Ground(), kFrame_s).placed);
  EXPECT_FALSE(filter.Step(StandingPerson(), {}, Ground(), kFrame_s).placed);
  const Posture far = Moved(StandingPerson(), {0.5, 0.0, 0.0});
  const auto out = filter.Step(far, {}, Ground(), 5.0);
  EXPECT_TRUE(out.placed);
  EXPECT_LT(LargestDistance(out.posture, far), 0.01);
}

TEST(CharacterFilter, RefusesImpossibleBonesAndOptions) {
  auto lengths = Lengths();
  lengths[5] = kNaN;
  EXPECT_THROW(CharacterFilter{lengths}, InputError);
  CharacterFilterOptions options;
  options.substeps = 0;
  EXPECT_THROW((CharacterFilter{Lengths(), options}), std::invalid_argument);
  options.substeps = 10;
  options.gains.rate_rad_s = 1000.0;
  EXPECT_THROW((CharacterFilter{Lengths(), options}), std::invalid_argument);
}

}  // namespace
}  // namespace ossa::physics
