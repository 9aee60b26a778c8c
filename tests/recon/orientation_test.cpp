#include "recon/orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace ossa::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// T-pose facing +z, left at +x; bones of one length along the rest frames' y axes.
Posture RestPosture() {
  Posture posture;
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    posture.position_m[i] =
        posture.position_m[parent] + 0.25 * (RestOrientations()[i] * Vector3d::UnitY());
  }
  return posture;
}

Posture Rotated(Posture posture, const Quaterniond& q) {
  for (auto& p : posture.position_m) p = q * p;
  return posture;
}

Posture RandomPosture(unsigned seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  Posture posture = RestPosture();
  for (auto& p : posture.position_m)
    p += 0.08 * Vector3d(normal(engine), normal(engine), normal(engine));
  return posture;
}

constexpr double kExact = 1e-9;  // a dozen roundings

TEST(Orientation, AtRestIsTheRestPose) {
  const auto orientation = ComputeOrientations(RestPosture());
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT(orientation[i].angularDistance(RestOrientations()[i]), kExact) << kJointNames[i];
  }
}

TEST(Orientation, RestAxesFollowTheConvention) {
  for (size_t i = 0; i < kJointCount; ++i) {
    const bool foot = i == 15 || i == 19;
    const Vector3d z = RestOrientations()[i] * Vector3d::UnitZ();
    EXPECT_LT((z - (foot ? Vector3d::UnitY() : Vector3d::UnitZ())).norm(), kExact)
        << kJointNames[i];
  }
}

TEST(Orientation, YRunsAlongTheBone) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Posture posture = RandomPosture(seed);
    const auto orientation = ComputeOrientations(posture);
    for (size_t i = 1; i < kJointCount; ++i) {
      const Vector3d bone = posture.position_m[i] - posture.position_m[ParentOf(i)];
      EXPECT_LT((orientation[i] * Vector3d::UnitY() - bone.normalized()).norm(), kExact);
    }
  }
}

TEST(Orientation, RotatesWithThePerson) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Posture posture = RandomPosture(seed);
    const Quaterniond turn(AngleAxisd(0.1 * seed, Vector3d(1, 2, -1).normalized()));
    const auto before = ComputeOrientations(posture),
               after = ComputeOrientations(Rotated(posture, turn));
    for (size_t i = 0; i < kJointCount; ++i) {
      // Looser than exact: a blend between nearly opposite axes magnifies roundings.
      EXPECT_LT(after[i].angularDistance(turn * before[i]), 1e-6) << kJointNames[i];
    }
  }
}

TEST(Orientation, PositiveRotationAboutXFlexesAnElbowAndANegativeOneAKnee) {
  struct Case {
    Joint upper, lower, end;
    Vector3d flexed;  // where the lower bone points when bent by 90 degrees in the rest pose
    double sign;
  };
  const Case cases[] = {
      {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft, Vector3d::UnitZ(), 1.0},
      {Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight, Vector3d::UnitZ(), 1.0},
      {Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kFootLeft, -Vector3d::UnitZ(), -1.0},
      {Joint::kKneeRight, Joint::kAnkleRight, Joint::kFootRight, -Vector3d::UnitZ(), -1.0}};
  for (const Case& c : cases) {
    Posture posture = RestPosture();
    posture[c.lower] = posture[c.upper] + 0.25 * c.flexed;
    posture[c.end] = posture[c.lower] + 0.25 * c.flexed;
    const auto relative = ToHierarchical(ComputeOrientations(posture));
    const AngleAxisd bend(relative[static_cast<size_t>(c.lower)]);
    EXPECT_NEAR(bend.angle(), 0.5 * M_PI, kExact) << NameOf(c.lower);
    EXPECT_NEAR(bend.axis().x(), c.sign, kExact) << NameOf(c.lower);
  }
}

TEST(Orientation, HierarchicalAndAbsoluteAreInverse) {
  const auto absolute = ComputeOrientations(RandomPosture(7));
  const auto again = ToAbsolute(ToHierarchical(absolute));
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT(absolute[i].angularDistance(again[i]), 1e-7);  // acos near 1
  }
}

TEST(Orientation, ToAndFromSdk2AreInverse) {
  const auto ours = ComputeOrientations(RandomPosture(8));
  for (size_t i = 0; i < kJointCount; ++i) {
    const auto joint = static_cast<Joint>(i);
    const auto sdk2 = OrientationToSdk2(joint, ours[i]);
    EXPECT_LT(OrientationFromSdk2(joint, sdk2).angularDistance(ours[i]), 1e-7);  // acos near 1
    // Both have y along the bone.
    EXPECT_LT((sdk2 * Eigen::Vector3d::UnitY() - ours[i] * Eigen::Vector3d::UnitY()).norm(),
              kExact);
  }
}

TEST(Orientation, IsAUnitQuaternionForAnyInput) {
  Posture posture = RandomPosture(3);
  posture[Joint::kElbowLeft].setConstant(std::numeric_limits<double>::quiet_NaN());
  posture[Joint::kKneeRight] = posture[Joint::kHipRight];
  posture[Joint::kSpine] = posture[Joint::kHipCenter];
  for (const Posture& p : {posture, Posture()}) {
    for (const auto& q : ComputeOrientations(p)) EXPECT_NEAR(q.norm(), 1.0, kExact);
  }
}

}  // namespace
}  // namespace ossa::recon
