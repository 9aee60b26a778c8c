// Joints, joint limits and orientations of a character.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "physics/character_filter.h"
#include "recon/orientation.h"
#include "tests/physics/person.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;
using recon::Joint;
using recon::Posture;
using test::DancingPerson;
using test::Ground;
using test::kFrame_s;
using test::Lengths;
using test::StandingPerson;

constexpr double kDegree = std::numbers::pi / 180.0;

Vector3d Axis(const FilteredPosture& out, size_t bone, const Vector3d& axis) {
  return out.orientation[bone] * axis;
}

double AngleBetween(const Vector3d& a, const Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) / kDegree;
}

FilteredPosture Settled(const Posture& target, const CharacterFilterOptions& options) {
  CharacterFilter filter(Lengths(), options);
  filter.Step(StandingPerson(), {}, Ground(), kFrame_s);
  FilteredPosture out;
  for (int i = 0; i < 45; ++i) out = filter.Step(target, {}, Ground(), kFrame_s);
  return out;
}

/// A joint bent further than people bend it.
struct Contortion {
  const char* name;
  size_t bone, parent;
  Vector3d direction;  // of the bone, its parent being as in the standing person
  double limit_deg;    // between the two bones, by the table in joint_limits.cpp
};

class Contortions : public testing::TestWithParam<Contortion> {
 protected:
  double AngleWith(bool limits) const {
    const Contortion& c = GetParam();
    Posture target = StandingPerson();
    // Everything attached to the bone moves with it.
    const Vector3d bone = target.position_m[c.bone] - target.position_m[c.parent];
    const Vector3d by = bone.norm() * c.direction.normalized() - bone;
    for (size_t j = c.bone; j < recon::kJointCount; ++j) {
      if (j == c.bone || recon::ParentOf(j) == c.bone) {
        target.position_m[j] += by;
      }
    }
    CharacterFilterOptions options;
    options.joint_limits = limits;
    options.self_collision = false;
    const auto out = Settled(target, options);
    return AngleBetween(Axis(out, c.bone, Vector3d::UnitY()),
                        Axis(out, c.parent, Vector3d::UnitY()));
  }
};

TEST_P(Contortions, EndAtTheRangeOfTheJoint) {
  EXPECT_GT(AngleWith(false), GetParam().limit_deg + 10.0);  // as the target asks
  EXPECT_LT(AngleWith(true), GetParam().limit_deg + 3.0);    // the bounded torque gives a little
}

INSTANTIATE_TEST_SUITE_P(
    Joints, Contortions,
    testing::Values(Contortion{"HeadOnTheBack", 3, 2, {0.0, -0.3, -1.0}, 60.0},
                    Contortion{"HeadOnTheShoulder", 3, 2, {1.0, -0.2, 0.0}, 60.0},
                    Contortion{"ForearmInTheUpperArm", 6, 5, {-0.3, 1.0, 0.25}, 150.0}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(JointLimits, StopAKneeFromBendingForwardsAndKeepTheHip) {
  Posture target = StandingPerson();
  const Vector3d thigh = (target[Joint::kKneeLeft] - target[Joint::kHipLeft]).normalized();
  const Vector3d forwards = (0.77 * thigh + 0.64 * Vector3d::UnitZ()).normalized();
  const Vector3d ankle = target[Joint::kKneeLeft] + 0.41 * forwards;
  target[Joint::kFootLeft] += ankle - target[Joint::kAnkleLeft];
  target[Joint::kAnkleLeft] = ankle;
  CharacterFilterOptions options;
  options.pin_feet = false;
  const auto turn = [&](const FilteredPosture& out) {
    return out.orientation[13].angularDistance(Settled(StandingPerson(), options).orientation[13]) /
           kDegree;
  };
  options.joint_limits = true;
  const auto out = Settled(target, options);
  const double bend =
      AngleBetween(Axis(out, 14, Vector3d::UnitY()), Axis(out, 13, Vector3d::UnitY()));
  EXPECT_LT(bend, 15.0);       // people's knees overstretch by 12 degrees in the table
  EXPECT_LT(turn(out), 20.0);  // the thigh: half a turn without limits, 70 degrees with motors only
  EXPECT_LT((out.posture[Joint::kKneeLeft] - target[Joint::kKneeLeft]).norm(), 0.04);
}

TEST(JointLimits, KeepPossiblePoses) {
  CharacterFilterOptions options;
  CharacterFilter free(Lengths(), options);
  options.joint_limits = true;
  CharacterFilter limited(Lengths(), options);
  for (int i = 0; i < 60; ++i) {
    const Posture target = test::Moved(StandingPerson(), {0.2 * std::sin(0.2 * i), 0.0, 0.0});
    const auto a = free.Step(target, {}, Ground(), kFrame_s);
    const auto b = limited.Step(target, {}, Ground(), kFrame_s);
    // Nothing beyond its range, no torque: the same simulation.
    ASSERT_LT(test::LargestDistance(a.posture, b.posture), 1e-6) << i;
  }
}

class Hinges : public testing::TestWithParam<bool> {};

TEST_P(Hinges, RotateAboutOneAxis) {
  CharacterFilterOptions options;
  options.hinges = GetParam();
  CharacterFilter filter(Lengths(), options);
  double error = 0.0, off = 0.0, gap = 0.0;
  Vector3d axis_of_parent[2];
  for (int i = 0; i < 150; ++i) {
    const Posture target = DancingPerson(i * kFrame_s);
    const auto out = filter.Step(target, {}, Ground(), kFrame_s);
    for (const size_t side : {0U, 1U}) {
      const size_t forearm = side == 0 ? 6 : 10;
      const Vector3d axis = Axis(out, forearm, Vector3d::UnitX());
      const Vector3d in_parent = out.orientation[forearm - 1].conjugate() * axis;
      if (i == 0) axis_of_parent[side] = in_parent;
      off = std::max(off, AngleBetween(in_parent, axis_of_parent[side]));
    }
    gap = std::max(gap, out.max_solver_gap_m);
    if (i > 15) error = std::max(error, test::LargestDistance(out.posture, target));
  }
  if (options.hinges) {
    EXPECT_LT(off, 2.0);  // what the iterative solver leaves
  } else {
    EXPECT_GT(off, 5.0);  // ball joints: the axis wanders with the posture
  }
  EXPECT_LT(gap, 0.5e-3);
  EXPECT_LT(error, 0.12);  // the wrist swings at 1.3 m/s; lag and the targets' wrong lengths
}

INSTANTIATE_TEST_SUITE_P(Elbows, Hinges, testing::Bool(),
                         [](const auto& info) { return info.param ? "hinged" : "ball"; });

TEST(Orientations, FollowTheSdkConventionOnceSettled) {
  const Posture goal = DancingPerson(1.0);
  CharacterFilterOptions options;
  options.pin_feet = false;
  const auto out = Settled(goal, options);
  const auto wanted = recon::ComputeOrientations(out.posture);
  for (size_t bone = 1; bone < recon::kJointCount; ++bone) {
    // y runs along the bone from parent to joint: exact, the bodies carry it.
    const auto parent = recon::ParentOf(bone);
    const Vector3d along = out.posture.position_m[bone] - out.posture.position_m[parent];
    EXPECT_LT(AngleBetween(Axis(out, bone, Vector3d::UnitY()), along), 0.01) << bone;
    // The turn about it is controlled (eq. 17) and has settled.
    EXPECT_LT(out.orientation[bone].angularDistance(wanted[bone]), 3.0 * kDegree) << bone;
  }
}

}  // namespace
}  // namespace ossa::physics
