#include "recon/files/marker_centres_internal.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <numbers>

#include "recon/files/skeleton_io.h"
#include "tests/support/places.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

constexpr double kExact_m = 1e-12;  // a handful of operations on lengths below two metres

/// The room's axes for a camera that looks down and to one side.
const Eigen::Quaterniond kCamFromRoom(Eigen::AngleAxisd(0.3, Vector3d(0.8, 0.0, 0.6)));

/// The pelvis of a person standing upright: ASIS 24 cm apart, PSIS 14 cm behind them. y is up in
/// the room.
Markers Pelvis(double heading_rad) {
  const Eigen::AngleAxisd turn(heading_rad, Vector3d::UnitY());
  const auto at = [&](double x, double z) {
    return Vector3d(kCamFromRoom * (Vector3d(0.4, 1.0, 2.5) + turn * Vector3d(x, 0, z)));
  };
  return {{"LASI", at(0.12, 0)},
          {"RASI", at(-0.12, 0)},
          {"LPSI", at(0.04, -0.14)},
          {"RPSI", at(-0.04, -0.14)}};
}

/// From the ASIS of the same side to the hip's centre.
Vector3d ToHip(const BodyRecord& body, Joint joint, const Vector3d& asis) {
  return body.joints[joint].value().position_m - asis;
}

// Bell et al. 1990, as shares of the distance between the ASIS: 30 % down, 19 % back, 14 % inwards.
// Down must not depend on rounding.
TEST(MarkerCentres, HipsAreBelowThePelvisForAnyHeading) {
  constexpr double kWidth_m = 0.24;
  const Vector3d up = kCamFromRoom * Vector3d::UnitY();
  for (int degrees = 0; degrees < 360; degrees += 10) {
    const Markers pelvis = Pelvis(degrees * std::numbers::pi / 180);
    const BodyRecord body = JointCentres(pelvis);
    const Vector3d leftwards = (pelvis.at("LASI") - pelvis.at("RASI")).normalized();
    const Vector3d forwards = leftwards.cross(up);
    const Vector3d left = ToHip(body, Joint::kHipLeft, pelvis.at("LASI"));
    const Vector3d right = ToHip(body, Joint::kHipRight, pelvis.at("RASI"));
    for (const Vector3d& hip : {left, right}) {
      EXPECT_NEAR(hip.dot(up), -0.30 * kWidth_m, kExact_m) << degrees;
      EXPECT_NEAR(hip.dot(forwards), -0.19 * kWidth_m, kExact_m) << degrees;
    }
    EXPECT_NEAR(left.dot(leftwards), -0.14 * kWidth_m, kExact_m) << degrees;
    EXPECT_NEAR(right.dot(leftwards), 0.14 * kWidth_m, kExact_m) << degrees;
  }
}

double LongestStep_m(const SkeletonSequence& sequence, Joint joint) {
  double longest_m = 0.0;
  const auto j = Index(joint);
  for (size_t f = 1; f < sequence.frames.size(); ++f) {
    const auto& before = sequence.frames[f - 1].bodies.at(0).joints[j];
    const auto& now = sequence.frames[f].bodies.at(0).joints[j];
    if (!before || !now) continue;
    longest_m = std::max(longest_m, (now->position_m - before->position_m).norm());
  }
  return longest_m;
}

// 5 cm in a hundredth of a second is 18 km/h: faster than a hip in any exercise.
TEST(MarkerCentres, HipsOfRealPeopleDoNotJump) {
  const std::string path = test::SharedFolder() / "real/uiprmd_kinect_vicon/raw_e05.tar.gz";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not here";
  const auto clips = ReadSkeletonClips(path + "#Vicon_Positions");
  EXPECT_GT(clips.size(), 60u);
  for (const SkeletonClip& clip : clips) {
    EXPECT_LT(LongestStep_m(clip.sequence, Joint::kHipLeft), 0.05) << clip.name;
    EXPECT_LT(LongestStep_m(clip.sequence, Joint::kHipRight), 0.05) << clip.name;
  }
}

}  // namespace
}  // namespace ossa::recon
