#include "recon/methods/reconstructor.h"

#include <gtest/gtest.h>

#include <limits>

#include "depth/base/error.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

std::shared_ptr<const PostureDatabase> Database() {
  static const auto db =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  return db;
}

/// Methods that need nothing learned.
std::vector<std::string> PlainMethods() {
  std::vector<std::string> names;
  for (const std::string& name : ReconstructionMethods()) {
    if (name != "liu-2016" && name != "full-gp" && name != "exemplar") names.push_back(name);
  }
  return names;
}

class EveryMethod : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Reconstructor> Make(
      const std::optional<BoneLengths>& bones_m = std::nullopt) const {
    ReconstructorOptions options;
    options.method = GetParam();
    options.database = Database();
    options.bones_m = bones_m;
    return MakeReconstructor(options);
  }
};

void ExpectFinite(const ReconstructedPosture& made) {
  for (const auto& p : made.posture.position_m) ASSERT_TRUE(p.allFinite());
  for (const double r : made.reliability) {
    ASSERT_GE(r, 0.0);
    ASSERT_LE(r, 1.0);
  }
}

TEST_P(EveryMethod, FollowsAWellObservedPerson) {
  for (const double scale : {0.9 / 1.66, 1.0, 2.2 / 1.66}) {  // people of 0.9 m, 1.66 m and 2.2 m
    const auto method = Make();
    double error = 0.0;
    for (int f = 0; f < 90; ++f) {
      const double t = f / 30.0;
      const Posture truth = test::InFrontOfCamera(test::Motion(t), scale);
      const auto made = method->Step({test::AllTracked(truth), t, nullptr});
      error += test::MeanDistance_m(made.posture, truth) / 90;
    }
    // The database's spacing is 20 cm at the fastest joint; a tracker must stay well inside it.
    EXPECT_LT(error, 0.06 * std::max(1.0, scale)) << scale;
  }
}

TEST_P(EveryMethod, GivesTheSamePosturesForTheSameSeed) {
  const auto a = Make(), b = Make();
  for (int f = 0; f < 10; ++f) {
    const auto observed = test::AllTracked(test::InFrontOfCamera(test::Motion(f / 30.0)));
    const auto one = a->Step({observed, f / 30.0, nullptr});
    const auto two = b->Step({observed, f / 30.0, nullptr});
    for (size_t i = 0; i < kJointCount; ++i) {
      ASSERT_EQ(one.posture.position_m[i], two.posture.position_m[i]);
    }
  }
}

TEST_P(EveryMethod, ForgetsThePersonWhenReset) {
  ReconstructorOptions options;
  options.method = GetParam();
  options.database = Database();
  options.local_pca.extend_database = true;
  const auto used = MakeReconstructor(options), fresh = MakeReconstructor(options);
  for (int f = 0; f < 60; ++f) {  // with a bowed head, which joins the database
    Posture seen = test::InFrontOfCamera(test::Motion(f / 30.0), 1.2);
    seen[Joint::kHead] -= Eigen::Vector3d(0.0, 0.15, 0.15);
    used->Step({test::AllTracked(seen), f / 30.0, nullptr});
  }
  used->Reset();
  for (int f = 0; f < 20; ++f) {
    const auto seen = test::AllTracked(test::InFrontOfCamera(test::Motion(f / 30.0)));
    const auto one = used->Step({seen, f / 30.0, nullptr});
    const auto two = fresh->Step({seen, f / 30.0, nullptr});
    for (size_t i = 0; i < kJointCount; ++i)
      ASSERT_EQ(one.posture.position_m[i], two.posture.position_m[i]) << f << " " << i;
  }
}

TEST_P(EveryMethod, StaysFiniteForInvalidInput) {
  const auto method = Make();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TrackedPosture good = test::AllTracked(test::InFrontOfCamera(test::Motion(0.0)));
  TrackedPosture nothing, nans = good, point = good, huge = good, swapped = good;
  for (auto& p : nans.posture.position_m) p.setConstant(nan);
  for (auto& p : point.posture.position_m) p = {0.0, 0.0, 2.0};
  for (auto& p : huge.posture.position_m) p *= 1e30;
  for (size_t i = 0; i < kJointCount; ++i) {
    swapped.posture.position_m[i] = good.posture.position_m[kMirroredJoint[i]];
  }
  double t = 0.0;
  for (const TrackedPosture* observed :
       {&nothing, &nans, &point, &huge, &good, &swapped, &nans, &nothing, &good, &point, &huge}) {
    for (const double step : {1.0 / 30, 0.0, -5.0, 30.0, 1e-9, nan}) {
      if (std::isfinite(step)) t += step;
      const auto made = method->Step({*observed, std::isfinite(step) ? t : step, nullptr});
      ExpectFinite(made);
    }
  }
}

// 1e200 m: a finite number whose square is none. Farther than anything is seen: as if absent.
TEST_P(EveryMethod, TreatsAnImpossiblyFarJointAsAbsent) {
  const auto far = Make(), absent = Make();
  for (int f = 0; f < 12; ++f) {
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(test::Motion(f / 30.0)));
    TrackedPosture without = seen;
    if (f == 4) {
      seen.posture.position_m[7].setConstant(1e200);
      without.state[7] = TrackingState::kNotTracked;
    }
    const auto made = far->Step({seen, f / 30.0, nullptr});
    const auto expected = absent->Step({without, f / 30.0, nullptr});
    ExpectFinite(made);
    for (size_t i = 0; i < kJointCount; ++i) {
      EXPECT_EQ(made.reliability[i], expected.reliability[i]) << f << " " << i;
      EXPECT_EQ(made.posture.position_m[i], expected.posture.position_m[i]) << f << " " << i;
    }
  }
}

// A logger gives two consecutive frames the same time stamp: the result must be as without the
// repetition. Steps of 1/32 s have no rounding.
TEST_P(EveryMethod, KeepsThePersonWhenATimeRepeats) {
  const auto right = Make(), repeating = Make();
  std::mt19937_64 rng(7);
  for (int f = 0; f < 12; ++f) {
    Posture posture = test::InFrontOfCamera(test::Motion(f / 32.0));
    test::AddNoise(posture, 0.01, rng);
    TrackedPosture seen = test::AllTracked(posture);
    seen.state[7] = f > 5 ? TrackingState::kNotTracked : TrackingState::kTracked;
    const int stamp = f == 11 ? 10 : f;
    const auto expected = right->Step({seen, f / 32.0, nullptr});
    const auto made = repeating->Step({seen, stamp / 32.0, nullptr});
    for (size_t i = 0; i < kJointCount; ++i) {
      ASSERT_EQ(made.posture.position_m[i], expected.posture.position_m[i]) << f << " " << i;
    }
    ASSERT_EQ(repeating->Revised().has_value(), right->Revised().has_value()) << f;
  }
}

TEST_P(EveryMethod, ReportsUnseenJointsAsUnreliable) {
  const auto method = Make();
  TrackedPosture observed = test::AllTracked(test::InFrontOfCamera(test::Motion(0.0)));
  for (int f = 0; f < 8; ++f) method->Step({observed, f / 30.0, nullptr});
  observed.state[7] = TrackingState::kNotTracked;
  observed.posture.position_m[7].setZero();
  const auto made = method->Step({observed, 8 / 30.0, nullptr});
  EXPECT_EQ(made.reliability[7], 0.0);
  EXPECT_GT(made.reliability[0], 0.9);
  // The hand stays on its arm, no farther from the elbow than a forearm and a hand reach.
  EXPECT_LT((made.posture.position_m[7] - made.posture.position_m[5]).norm(), 0.4);
}

class MethodWithBones : public EveryMethod {};

TEST_P(MethodWithBones, KeepsBoneLengthsConstant) {
  EXPECT_TRUE(RequireMethod(GetParam()).keeps_bones);
  const auto method = Make();
  std::mt19937_64 rng(5);
  BoneLengths first{};
  for (int f = 0; f < 60; ++f) {
    Posture seen = test::InFrontOfCamera(test::Motion(f / 30.0), 1.1);
    test::AddNoise(seen, 0.01, rng);
    const auto lengths =
        MeasureBoneLengths(method->Step({test::AllTracked(seen), f / 30.0, nullptr}).posture);
    if (f == 0) first = lengths;
    for (size_t i = 1; i < kJointCount; ++i) {
      EXPECT_NEAR(lengths[i], first[i], 0.001 * first[i]) << f << " " << i;
    }
  }
}

// Whatever is observed, from the first frame on: an arm too long in the first frame, noise, another
// person's size for seconds.
TEST_P(MethodWithBones, KeepsGivenBones) {
  BoneLengths known = ScaledBoneLengths(1.1);
  known[5] *= 0.9;
  const auto method = Make(known);
  std::mt19937_64 rng(5);
  for (int f = 0; f < 150; ++f) {
    Posture seen = test::InFrontOfCamera(test::Motion(f / 30.0), f > 60 ? 0.6 : 1.1);
    if (f == 0) seen.position_m[7] += 0.4 * (seen.position_m[7] - seen.position_m[5]);
    test::AddNoise(seen, 0.01, rng);
    if (f == 30) method->Reset();
    const auto lengths =
        MeasureBoneLengths(method->Step({test::AllTracked(seen), f / 30.0, nullptr}).posture);
    for (size_t i = 1; i < kJointCount; ++i) {
      ASSERT_NEAR(lengths[i], known[i], 1e-5) << f << " " << i;
    }
  }
  EXPECT_EQ(method->Bones(), known);
}

// In the first frame the right arm is half as long again; the typical length is reported
// nevertheless.
TEST_P(MethodWithBones, ReportsBonesOfAllPeople) {
  const auto method = Make();
  std::mt19937_64 rng(5);
  for (int f = 0; f < 60; ++f) {
    Posture seen = test::InFrontOfCamera(test::Motion(f / 30.0), 1.1);
    if (f == 0) seen.position_m[9] += 0.5 * (seen.position_m[9] - seen.position_m[8]);
    test::AddNoise(seen, 0.005, rng);
    method->Step({test::AllTracked(seen), f / 30.0, nullptr});
  }
  const auto bones = method->Bones();
  ASSERT_TRUE(bones.has_value());
  const BoneLengths truth = ScaledBoneLengths(1.1);
  for (const size_t i : {5U, 6U, 9U, 10U, 13U, 14U, 17U, 18U}) {
    EXPECT_NEAR((*bones)[i], truth[i], 0.05 * truth[i]) << i;
  }
}

std::string NameOfCase(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::ValuesIn(PlainMethods()), NameOfCase);
// Filters move joints independently and do not preserve bones.
INSTANTIATE_TEST_SUITE_P(Methods, MethodWithBones,
                         testing::Values("shum-ho-2012", "shum-2013", "plantard-2016", "best"),
                         NameOfCase);

/// A wall at one depth, seen by a Kinect.
depth::DepthFrame Wall(double depth_m) {
  depth::DepthFrame frame;
  frame.camera = {640, 480, 575.0, 575.0, 320.0, 240.0};
  frame.depth_mm.assign(640 * 480, static_cast<uint16_t>(1000.0 * depth_m));
  return frame;
}

TEST(Best, RepairsAHandThatTheDepthImageDoesNotShow) {
  ReconstructorOptions options;
  options.database = Database();
  const auto method = MakeReconstructor(options);
  const Posture truth = test::InFrontOfCamera(test::Gesture(0.5, 0.5, 0.0));  // flat, at 2.5 m
  const depth::DepthFrame skin = Wall(2.45);
  for (int f = 0; f < 10; ++f) method->Step({test::AllTracked(truth), f / 30.0, &skin});
  // The hand and wrist are said to be half a metre in front of the surface, in free air.
  Posture wrong = truth;
  for (const size_t j : {size_t{6}, size_t{7}}) wrong.position_m[j].z() -= 0.5;
  const auto made = method->Step({test::AllTracked(wrong), 10 / 30.0, &skin});
  EXPECT_EQ(made.reliability[7], 0.0);
  EXPECT_GT(made.reliability[11], 0.9);
  EXPECT_LT((made.posture.position_m[7] - truth.position_m[7]).norm(), 0.1);  // of 0.5
}

TEST(MakeReconstructor, NamesTheUnknownMethodAndTheMissingDatabase) {
  ReconstructorOptions options;
  options.method = "magic";
  EXPECT_THROW(MakeReconstructor(options), InputError);
  options.method = "shum-2013";
  EXPECT_THROW(MakeReconstructor(options), InputError);
}

TEST(MakeReconstructor, RefusesInvalidBonesAndMethodsWithoutBones) {
  ReconstructorOptions options;
  options.bones_m = StandardBoneLengths();
  EXPECT_NO_THROW(MakeReconstructor(options));
  options.method = "one-euro";
  EXPECT_THROW(MakeReconstructor(options), InputError);
  options.method = "best";
  for (const double impossible : {0.0, -0.1, 1e30, std::numeric_limits<double>::quiet_NaN()}) {
    (*options.bones_m)[7] = impossible;
    EXPECT_THROW(MakeReconstructor(options), InputError) << impossible;
  }
}

}  // namespace
}  // namespace ossa::recon
