// Properties of the papers' methods that follow from normalisation (Shum & Ho 2012, secs. 5.1, 7).
#include <gtest/gtest.h>

#include <array>

#include "recon/methods/reconstructor.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

std::shared_ptr<const PostureDatabase> GestureDatabase() {
  static const auto made =
      std::make_shared<const PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  return made;
}

std::shared_ptr<const PostureDatabase> OnePosture() {
  return std::make_shared<const PostureDatabase>(
      PostureDatabase::Build({{"one", {test::Gesture(0.5, 0.4, 0.3)}, {}}}, {}));
}

/// What is seen in a frame: a moving person, an arm of whom is guessed or missing at times.
TrackedPosture SeenAt(int frame) {
  TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Motion(frame / 30.0)));
  for (size_t i = 5; i < 8; ++i) {
    if (frame >= 10 && frame < 20) seen.state[i] = TrackingState::kInferred;
    if (frame >= 20 && frame < 30) seen.state[i] = TrackingState::kNotTracked;
  }
  return seen;
}

class PaperMethod : public testing::TestWithParam<std::string> {
 protected:
  using Change = Eigen::Vector3d (*)(const Eigen::Vector3d&);

  static std::unique_ptr<Reconstructor> Make(
      const std::shared_ptr<const PostureDatabase>& database) {
    ReconstructorOptions options;
    options.method = GetParam();
    options.database = database;
    return MakeReconstructor(options);
  }

  /// Largest distance between what is made of changed observations and the changed result.
  static double LargestDifference_m(Change change) {
    const auto plain = Make(GestureDatabase()), changed = Make(GestureDatabase());
    double largest_m = 0.0;
    for (int f = 0; f < 40; ++f) {
      const TrackedPosture seen = SeenAt(f);
      TrackedPosture moved = seen;
      for (auto& p : moved.posture.position_m) p = change(p);
      const Posture expected = plain->Step({seen, f / 30.0, nullptr}).posture;
      const Posture made = changed->Step({moved, f / 30.0, nullptr}).posture;
      for (size_t i = 0; i < kJointCount; ++i) {
        const Eigen::Vector3d off = made.position_m[i] - change(expected.position_m[i]);
        largest_m = std::max(largest_m, off.norm());
      }
    }
    return largest_m;
  }
};

// Tolerances: single precision, in which a search among random samples may decide otherwise.
TEST_P(PaperMethod, MovesWithThePerson) {
  EXPECT_LT(LargestDifference_m([](const Eigen::Vector3d& p) {
              return Eigen::Vector3d(p + Eigen::Vector3d(-0.7, 0.3, 1.1));
            }),
            0.001);
}

TEST_P(PaperMethod, TurnsWithThePerson) {
  EXPECT_LT(LargestDifference_m([](const Eigen::Vector3d& p) {
              return Eigen::Vector3d(Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitY()) * p);
            }),
            0.001);
}

TEST_P(PaperMethod, GrowsWithThePerson) {
  EXPECT_LT(LargestDifference_m([](const Eigen::Vector3d& p) { return Eigen::Vector3d(1.2 * p); }),
            0.001);
}

// K is larger than the database; its covariance is 0.
TEST_P(PaperMethod, WorksWithASinglePosture) {
  const auto method = Make(OnePosture());
  for (int f = 0; f < 40; ++f) {
    const auto made = method->Step({SeenAt(f), f / 30.0, nullptr});
    for (const auto& p : made.posture.position_m) ASSERT_TRUE(p.allFinite()) << f;
    const BoneLengths lengths = MeasureBoneLengths(made.posture);
    for (size_t i = 1; i < kJointCount; ++i) {
      ASSERT_NEAR(lengths[i], StandardBoneLengths()[i], 1e-4) << f << " " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, PaperMethod,
                         testing::Values("shum-ho-2012", "shum-2013", "plantard-2016"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace ossa::recon
