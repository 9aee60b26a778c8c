// Tilted cameras: every method is as accurate as with a level one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>

#include "recon/files/skeleton_io.h"
#include "recon/methods/level_internal.h"
#include "recon/orientation.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/places.h"

namespace ossa::recon {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kStep_s = 1.0 / 30.0;
constexpr double kDegree = M_PI / 180.0;

/// Transform from a level camera's space to that of a camera tilted down by this much.
Isometry3d TiltedBy(double tilt_deg) {
  return Isometry3d(AngleAxisd(-tilt_deg * kDegree, Vector3d::UnitX()));
}

/// The floor 1.2 m below the camera.
Eigen::Vector4d FloorOf(const Isometry3d& tilt) {
  const Vector3d up = tilt * Vector3d::UnitY();
  return {up.x(), up.y(), up.z(), 1.2};
}

Posture At(int frame) {
  // A second of standing straight, then the move.
  constexpr int kStanding = 30;
  if (frame < kStanding) return test::InFrontOfCamera(test::Gesture(0.9, 0.9, 0.7));
  return test::InFrontOfCamera(test::Motion((frame - kStanding) * kStep_s));
}

bool IsLeg(size_t joint) { return joint > Index(Joint::kHipLeft) && joint != 16; }

std::unique_ptr<Reconstructor> Make(const std::string& name) {
  static const auto db =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  ReconstructorOptions options;
  options.method = name;
  options.database = db;
  return MakeReconstructor(options);
}

/// Mean error of two seconds without legs, after the second of standing.
double MeanError_m(const std::string& name, double tilt_deg, bool with_floor) {
  const auto method = Make(name);
  const Isometry3d tilt = TiltedBy(tilt_deg);
  double sum_m = 0.0;
  constexpr int kFrom = 40, kTo = 100;
  for (int f = 0; f < kTo; ++f) {
    const Posture truth = Moved(At(f), tilt);
    TrackedPosture seen = test::AllTracked(truth);
    for (size_t i = 0; i < kJointCount && f >= kFrom; ++i) {
      if (IsLeg(i)) seen.state[i] = TrackingState::kNotTracked;
    }
    ReconstructionInput input{seen, f * kStep_s, nullptr};
    if (with_floor) input.floor = FloorOf(tilt);
    const auto made = method->Step(input);
    if (f >= kFrom) sum_m += test::MeanDistance_m(made.posture, truth) / (kTo - kFrom);
  }
  return sum_m;
}

class TiltedCamera : public testing::TestWithParam<std::string> {};

TEST_P(TiltedCamera, WithAFloorIsAsGoodAsALevelOne) {
  const double level_m = MeanError_m(GetParam(), 0.0, true);
  for (const double tilt_deg : {10.0, 20.0, 27.0}) {
    EXPECT_NEAR(MeanError_m(GetParam(), tilt_deg, true), level_m, 0.01) << tilt_deg;
  }
}

TEST_P(TiltedCamera, WithoutAFloorIsLevelledByAStandingPerson) {
  const double level_m = MeanError_m(GetParam(), 0.0, false);
  // A fifth of what a method guesses the hidden legs to be, where that is more.
  EXPECT_NEAR(MeanError_m(GetParam(), 27.0, false), level_m, std::max(0.01, 0.2 * level_m));
}

INSTANTIATE_TEST_SUITE_P(Methods, TiltedCamera,
                         testing::Values("none", "one-euro", "shum-ho-2012", "shum-2013",
                                         "plantard-2016", "best"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(LevelEstimator, KeepsALevelCamera) {
  LevelEstimator level;
  for (int f = 0; f < 60; ++f) {
    // A person leaning by five degrees is not a tilt of the camera.
    const Posture leaning = Moved(At(0), TiltedBy(5.0));
    EXPECT_FALSE(level.Update(test::AllTracked(leaning), std::nullopt)) << f;
  }
}

/// Error of the estimated level after two seconds of this posture; none if the camera counts as
/// level.
std::optional<double> LevelledOffBy_deg(const Posture& staying, double tilt_deg) {
  LevelEstimator level;
  std::optional<Isometry3d> made;
  for (int f = 0; f < 60; ++f) {
    made = level.Update(test::AllTracked(Moved(staying, TiltedBy(tilt_deg))), std::nullopt);
  }
  if (!made) return std::nullopt;
  const Vector3d up = made->linear() * (TiltedBy(tilt_deg) * Vector3d::UnitY());
  return std::acos(std::min(1.0, up.y())) / kDegree;
}

// With bent knees the centre of mass is still above the feet.
TEST(LevelEstimator, EstimatesTheTiltFromAPersonWithBentKnees) {
  const Posture bent = test::InFrontOfCamera(test::Gesture(0.3, 0.3, 0.3, 0.5));
  const auto off_deg = LevelledOffBy_deg(bent, 20.0);
  ASSERT_TRUE(off_deg.has_value());
  EXPECT_LT(*off_deg, 5.0);
  EXPECT_FALSE(LevelledOffBy_deg(bent, 0.0).has_value());
}

// On one leg the midpoint of the feet is not the point of support.
TEST(LevelEstimator, LearnsNothingFromAPersonOnOneLeg) {
  Posture raised = test::InFrontOfCamera(test::Gesture(0.3, 0.3, 0.3));
  for (const Joint joint : {Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kFootLeft}) {
    const Vector3d hip = raised[Joint::kHipLeft];
    raised[joint] = hip + AngleAxisd(70.0 * kDegree, Vector3d::UnitX()) * (raised[joint] - hip);
  }
  EXPECT_FALSE(LevelledOffBy_deg(raised, 0.0).has_value());
}

// In front of a level camera: a lunge sideways, and a raised straight leg.
TEST(LevelEstimator, KeepsTheLevelDuringRealExercises) {
  const auto file = ossa::test::SharedFolder() / "real/uiprmd_kinect_vicon/raw_e05.tar.gz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
  for (const std::string name : {"m04_s10_e05", "m06_s01_e05", "m06_s10_e05"}) {
    const auto recording = ReadSkeletons(file.string() + "#Vicon_Positions/" + name);
    ASSERT_GT(recording.frames.size(), 100U);
    LevelEstimator level;
    for (const SkeletonFrame& frame : recording.frames) {
      if (frame.bodies.empty()) continue;
      ASSERT_FALSE(level.Update(ToTrackedPosture(frame.bodies[0]), std::nullopt)) << name;
    }
  }
}

TEST(LevelEstimator, DoesNotTakeALyingPersonForAStandingOne) {
  LevelEstimator level;
  const Posture lying = Moved(At(0), TiltedBy(80.0));
  for (int f = 0; f < 60; ++f) {
    EXPECT_FALSE(level.Update(test::AllTracked(lying), std::nullopt)) << f;
  }
}

/// The level after a floor was seen for `frames`.
std::optional<Isometry3d> LevelByFloor(LevelEstimator& level, double tilt_deg, int frames) {
  std::optional<Isometry3d> made;
  for (int f = 0; f < frames; ++f) {
    made = level.Update(test::AllTracked(At(f)), FloorOf(TiltedBy(tilt_deg)));
  }
  return made;
}

TEST(LevelEstimator, KeepsTheLevelWhileTheFloorIsNoisy) {
  LevelEstimator level;
  const auto first = LevelByFloor(level, 20.0, 9);
  ASSERT_TRUE(first);
  const auto later = LevelByFloor(level, 21.5, 9);
  ASSERT_TRUE(later);
  EXPECT_TRUE(first->isApprox(*later));
}

TEST(LevelEstimator, DoesNotAcceptATableAsFloorAtOnce) {
  LevelEstimator level;
  EXPECT_FALSE(LevelByFloor(level, 35.0, 2));
  const auto first = LevelByFloor(level, 20.0, 9);
  ASSERT_TRUE(first);
  EXPECT_TRUE(first->isApprox(*LevelByFloor(level, 35.0, 2)));
}

TEST(LevelEstimator, FollowsAChangedTilt) {
  LevelEstimator level;
  const auto first = LevelByFloor(level, 20.0, 9);
  const auto later = LevelByFloor(level, 10.0, 9);
  ASSERT_TRUE(first && later);
  const Vector3d up = later->linear() * (TiltedBy(10.0) * Vector3d::UnitY());
  EXPECT_LT((up - Vector3d::UnitY()).norm(), 1e-6);
}

TEST(LevelEstimator, KeepsTheLevelWhileTheFloorIsLost) {
  LevelEstimator level;
  const auto first = LevelByFloor(level, 20.0, 9);
  ASSERT_TRUE(first);
  const Posture leaning = Moved(At(0), TiltedBy(10.0));
  for (int f = 0; f < 60; ++f) {
    const auto later = level.Update(test::AllTracked(leaning), std::nullopt);
    ASSERT_TRUE(later);
    EXPECT_TRUE(first->isApprox(*later)) << f;
  }
}

TEST(Levelled, OrientationsAreInCameraSpace) {
  const auto method = Make("shum-2013");
  const Isometry3d tilt = TiltedBy(25.0);
  ReconstructedPosture made;
  for (int f = 0; f < 9; ++f) {
    ReconstructionInput input{test::AllTracked(Moved(At(f), tilt)), f * kStep_s, nullptr};
    input.floor = FloorOf(tilt);
    made = method->Step(input);
  }
  ASSERT_TRUE(made.orientation);
  for (size_t i = 1; i < kJointCount; ++i) {
    const Vector3d bone = made.posture.position_m[i] - made.posture.position_m[ParentOf(i)];
    EXPECT_LT(((*made.orientation)[i] * Vector3d::UnitY() - bone.normalized()).norm(), 1e-6) << i;
  }
}

}  // namespace
}  // namespace ossa::recon
