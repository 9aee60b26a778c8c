#include "recon/methods/bone_turns_internal.h"

#include <gtest/gtest.h>

#include <array>

#include "recon/orientation.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr size_t kForearm = 6;

/// Two postures, far enough apart for both to stay, with forearms turned about themselves.
PostureDatabase TwoPostures(double first_rad, double second_rad) {
  std::vector<PostureClip> clips(2);
  const std::array<Posture, 2> postures = {test::Gesture(0.2, 0.2, 0.1),
                                           test::Gesture(1.6, 0.2, 0.8)};
  for (size_t k = 0; k < 2; ++k) {
    clips[k].name = "gesture";
    clips[k].postures = {postures[k]};
    JointOrientations turned = ComputeOrientations(postures[k]);
    turned[kForearm] = turned[kForearm] *
                       Quaterniond(AngleAxisd(k == 0 ? first_rad : second_rad, Vector3d::UnitY()));
    clips[k].orientations = {turned};
  }
  return PostureDatabase::Build(clips, {});
}

/// How far a bone is turned about itself from what the joints tell.
double Twist_rad(const JointOrientations& orientations, const Posture& posture, size_t bone) {
  const Vector3d x =
      ComputeOrientations(posture)[bone].conjugate() * (orientations[bone] * Vector3d::UnitX());
  return std::atan2(-x.z(), x.x());
}

TEST(TurnedOntoBones, OnePostureRotatesWithThePerson) {
  const PostureDatabase database = TwoPostures(0.5, 0.0);
  const double yaw_rad = 2.1;
  const Posture in_camera = Placed(database.posture(0), {{0.3, 0.1, 2.5}, yaw_rad});
  const std::array<int, 1> postures = {0};
  const std::array<double, 1> weights = {1.0};
  const auto turned = TurnedOntoBones(database, postures, weights, in_camera, yaw_rad);
  EXPECT_NEAR(Twist_rad(turned, in_camera, kForearm), 0.5, 0.01);  // single precision, normalised
  EXPECT_NEAR(Twist_rad(turned, in_camera, 10), 0.0, 0.01);
}

TEST(TurnedOntoBones, PutsTheYAxisAlongTheBoneOfThePostureMade) {
  const PostureDatabase database = TwoPostures(0.5, -0.3);
  const Posture made = test::InFrontOfCamera(test::Gesture(0.9, 0.7, 0.4));
  const std::array<int, 2> postures = {0, 1};
  const std::array<double, 2> weights = {2.0, 1.0};
  const auto turned = TurnedOntoBones(database, postures, weights, made, 3.1);
  for (size_t i = 1; i < kJointCount; ++i) {
    const Vector3d bone = made.position_m[i] - made.position_m[ParentOf(i)];
    EXPECT_LT((turned[i] * Vector3d::UnitY() - bone.normalized()).norm(), 1e-6) << i;
  }
}

// Of one posture twice, turned apart: the mean turn, by the weights.
TEST(TurnedOntoBones, IsTheWeightedMeanOfTheTurns) {
  std::vector<PostureClip> clips(2);
  for (size_t k = 0; k < 2; ++k) {
    clips[k].name = "gesture";
    // A centimetre apart: one posture for a forearm, two for the filter.
    clips[k].postures = {test::Gesture(0.2 + 0.02 * static_cast<double>(k), 0.2, 0.1)};
    JointOrientations turned = ComputeOrientations(clips[k].postures[0]);
    turned[kForearm] =
        turned[kForearm] * Quaterniond(AngleAxisd(0.4 * static_cast<double>(k), Vector3d::UnitY()));
    if (k == 1) turned[kForearm].coeffs() *= -1.0;  // the same rotation
    clips[k].orientations = {turned};
  }
  DatabaseOptions options;
  options.threshold_m = 1e-3;
  const auto database = PostureDatabase::Build(clips, options);
  ASSERT_EQ(database.size(), 2);
  const Posture made = database.posture(0);
  const std::array<int, 2> postures = {0, 1};
  const auto twist_rad = [&](double first, double second) {
    const std::array<double, 2> weights = {first, second};
    return Twist_rad(TurnedOntoBones(database, postures, weights, made, 0.0), made, kForearm);
  };
  EXPECT_NEAR(twist_rad(1.0, 1.0), 0.2, 0.02);
  EXPECT_NEAR(twist_rad(3.0, 1.0), 0.1, 0.02);
}

}  // namespace
}  // namespace ossa::recon
