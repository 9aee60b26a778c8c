// The orientations of a posed rig follow the same convention as those derived from joints
// (recon/orientation.h).
#include <gtest/gtest.h>

#include "recon/body/standard_body.h"
#include "recon/database/posture_database.h"
#include "recon/orientation.h"
#include "tests/support/places.h"

namespace ossa::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kExact = 1e-6;  // angles near 0 amplify a quaternion's rounding

TEST(RigOrientations, AtRestEqualThoseOfTheJoints) {
  const auto rig = ComputeOrientations(RigPose{});
  const auto joints = ComputeOrientations(StandardPosture(RigPose{}));
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT(rig[i].angularDistance(joints[i]), kExact) << kJointNames[i];
  }
}

TEST(RigOrientations, RotateWithTheWholeBody) {
  const Quaterniond turn(AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  RigPose pose;
  pose.world_from_rest.fill(turn);
  const auto rig = ComputeOrientations(pose);
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT(rig[i].angularDistance(turn * StandardOrientations()[i]), kExact) << kJointNames[i];
  }
}

// Forearm and hand rotated about the forearm: no joint up to the wrist moves, but the forearm's
// orientation shows the twist about its own y axis.
TEST(RigOrientations, HaveTheTwistThatJointsLack) {
  constexpr double kTwist_rad = 0.9;
  const Posture rest = StandardPosture(RigPose{});
  const Vector3d along = (rest[Joint::kWristLeft] - rest[Joint::kElbowLeft]).normalized();
  RigPose pose;
  for (const char* bone : {"LeftForeArm", "LeftHand"}) {
    pose.world_from_rest[RigBone(bone)] = AngleAxisd(kTwist_rad, along);
  }
  const Posture twisted = StandardPosture(pose);
  ASSERT_LT((twisted[Joint::kWristLeft] - rest[Joint::kWristLeft]).norm(), kExact);
  const Quaterniond before = StandardOrientations()[Index(Joint::kWristLeft)];
  const Quaterniond after = ComputeOrientations(pose)[Index(Joint::kWristLeft)];
  const Quaterniond twist(AngleAxisd(kTwist_rad, Vector3d::UnitY()));
  EXPECT_LT((before.conjugate() * after).angularDistance(twist), kExact);
}

// An arm raised sideways from hanging to a T-pose: z axes point forwards, as in the SDK's rest
// pose.
TEST(RigOrientations, RaisedArmEqualsTheTPose) {
  const Posture rest = StandardPosture(RigPose{});
  const Vector3d upper = (rest[Joint::kElbowLeft] - rest[Joint::kShoulderLeft]).normalized();
  const Quaterniond raise = Quaterniond::FromTwoVectors(upper, Vector3d::UnitX());
  RigPose pose;
  for (const char* bone : {"LeftArm", "LeftForeArm", "LeftHand"}) {
    pose.world_from_rest[RigBone(bone)] = raise;
  }
  const auto rig = ComputeOrientations(pose);
  const size_t elbow = Index(Joint::kElbowLeft);
  const Vector3d z = rig[elbow] * Vector3d::UnitZ();
  EXPECT_GT(z.z(), 0.95);  // within 18 degrees: the rig's elbow does not bend exactly forwards
}

/// Mean angle between a database's orientations and those derived from its joints, over bones whose
/// axial rotation joints determine well: trunk, thighs, shins, and the bones to the shoulders.
double MeanOff_deg(const PostureDatabase& database) {
  double sum_rad = 0.0;
  int count = 0;
  for (int k = 0; k < database.size(); k += 50) {
    const auto known = database.orientations(k), told = ComputeOrientations(database.posture(k));
    for (const size_t bone : {1U, 2U, 4U, 8U, 13U, 14U, 17U, 18U}) {
      sum_rad += known[bone].angularDistance(told[bone]);
      ++count;
    }
  }
  return sum_rad / count * 180.0 / M_PI;
}

// The shipped file has version 1, whose orientations are relative to hanging arms: unconverted they
// would be off by 90 degrees and more.
TEST(PostureDatabase, VersionOneIsConvertedToTheJointsConvention) {
  const auto database =
      PostureDatabase::Load(test::SourceFolder() / "tools/tracker/shipped/authored.ossadb");
  EXPECT_LT(MeanOff_deg(database), 25.0);
}

TEST(PostureDatabase, ClipsWithoutOrientationsGetThoseOfTheJoints) {
  PostureClip clip;
  clip.name = "still";
  clip.postures.push_back(StandardPosture(RigPose{}));
  const auto database = PostureDatabase::Build({clip}, {});
  const auto told = ComputeOrientations(database.posture(0));
  for (size_t i = 1; i < kJointCount; ++i) {
    EXPECT_LT(database.orientations(0)[i].angularDistance(told[i]), 0.02) << kJointNames[i];
  }
}

}  // namespace
}  // namespace ossa::recon
