// Whole recordings: several people, bones by all frames, what is absent.
#include "recon/methods/reconstruct_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "depth/base/error.h"
#include "recon/filters/butterworth.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

constexpr double kStep_s = 1.0 / 30.0;
constexpr size_t kForearm = 6, kHand = 7;

Posture At(double time_s) { return test::InFrontOfCamera(test::Motion(time_s)); }

void AddBody(SkeletonFrame& frame, int id, const Posture& posture) {
  BodyRecord& body = frame.bodies.emplace_back();
  body.id = id;
  for (size_t i = 0; i < kJointCount; ++i)
    body.joints[i].emplace().position_m = posture.position_m[i];
}

SkeletonSequence Recording(int frames, const std::vector<int>& ids) {
  SkeletonSequence sequence;
  for (int f = 0; f < frames; ++f) {
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = f;
    frame.time_s = f * kStep_s;
    for (const int id : ids) AddBody(frame, id, At(frame.time_s));
  }
  return sequence;
}

std::vector<double> Forearms_m(const SkeletonSequence& sequence, size_t body) {
  std::vector<double> lengths_m;
  for (const SkeletonFrame& frame : sequence.frames) {
    const Posture posture = ToTrackedPosture(frame.bodies.at(body)).posture;
    lengths_m.push_back(MeasureBoneLengths(posture)[kForearm]);
  }
  return lengths_m;
}

class OrientationsOf : public testing::TestWithParam<std::string> {};

TEST_P(OrientationsOf, EveryMethodLieAlongTheBones) {
  ReconstructorOptions options;
  options.method = GetParam();
  options.database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  const auto made = ReconstructSequence(Recording(8, {3}), options);
  for (const SkeletonFrame& frame : made.frames) {
    const auto& joints = frame.bodies.at(0).joints;
    for (size_t i = 1; i < kJointCount; ++i) {
      ASSERT_TRUE(joints[i]->orientation) << kJointNames[i];
      const Eigen::Vector3d bone = joints[i]->position_m - joints[ParentOf(i)]->position_m;
      const Eigen::Vector3d y = *joints[i]->orientation * Eigen::Vector3d::UnitY();
      EXPECT_LT((y - bone.normalized()).norm(), 1e-6) << kJointNames[i];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, OrientationsOf,
                         testing::Values("none", "kalman", "shum-ho-2012", "shum-2013", "best"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(ButterworthSequence, WritesOrientationsAlongTheBones) {
  const auto made = ButterworthSequence(Recording(8, {3}));
  const auto& joints = made.frames[4].bodies.at(0).joints;
  for (size_t i = 1; i < kJointCount; ++i) {
    ASSERT_TRUE(joints[i]->orientation) << kJointNames[i];
    const Eigen::Vector3d bone = joints[i]->position_m - joints[ParentOf(i)]->position_m;
    const Eigen::Vector3d y = *joints[i]->orientation * Eigen::Vector3d::UnitY();
    EXPECT_LT((y - bone.normalized()).norm(), 1e-6) << kJointNames[i];
  }
}

TEST(ReconstructSequence, WritesTheRevisedPosturesAndTheLastOneAsItIs) {
  const SkeletonSequence sequence = Recording(10, {0});
  const auto made = ReconstructSequence(sequence, {});
  const auto method = MakeReconstructor({});
  ReconstructedPosture last;
  for (size_t f = 0; f < 10; ++f) {
    last = method->Step(
        {ToTrackedPosture(sequence.frames[f].bodies[0]), sequence.frames[f].time_s, nullptr});
    if (f == 0) continue;
    const auto& written = made.frames[f - 1].bodies.at(0).joints[kHand]->position_m;
    EXPECT_EQ(written, method->Revised()->posture.position_m[kHand]) << f;
  }
  EXPECT_EQ(made.frames[9].bodies.at(0).joints[kHand]->position_m, last.posture.position_m[kHand]);
}

TEST(ReconstructSequence, RefusesAFrameThatHasABodyTwice) {
  SkeletonSequence sequence = Recording(3, {4});
  sequence.source = "walk.csv";
  sequence.frames[2].bodies.push_back(sequence.frames[2].bodies[0]);
  try {
    ReconstructSequence(sequence, {});
    FAIL() << "a body stood twice in frame 2";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "walk.csv: frame 2: expected each body once, found two of id 4");
  }
}

// Two people, the second with a forearm that the first two frames have too long: bones by the whole
// recording are nearer the truth, and the same in every frame.
TEST(MeasureBones, WholeRecordingGivesConstantBones) {
  SkeletonSequence sequence = Recording(60, {4, 9});
  for (int f = 0; f < 2; ++f) {
    for (const size_t joint : {kForearm, kHand})
      sequence.frames[static_cast<size_t>(f)].bodies[1].joints[joint]->position_m.y() -= 0.15;
  }
  const BoneLengthsById bones = MeasureBones(sequence, {});
  ASSERT_EQ(bones.size(), 2U);
  const double truth_m = MeasureBoneLengths(At(0.0))[kForearm];
  EXPECT_NEAR(bones.at(9)[kForearm], truth_m, 0.02);
  EXPECT_GT(Forearms_m(ReconstructSequence(sequence, {}), 1).front(), truth_m + 0.04);
  for (const double m : Forearms_m(ReconstructSequence(sequence, {}, {}, bones), 1))
    EXPECT_NEAR(m, bones.at(9)[kForearm], 1e-6);
  ReconstructorOptions filter;
  filter.method = "one-euro";
  EXPECT_TRUE(MeasureBones(sequence, filter).empty());
}

// Memory of people who left is freed, but their measurements are kept.
TEST(MeasureBones, IncludesPeopleWhoLeftEarly) {
  SkeletonSequence sequence = Recording(30, {4});
  const SkeletonSequence later = Recording(30, {9});
  for (SkeletonFrame frame : later.frames) {
    frame.frame += 30;
    frame.time_s += 100.0;
    sequence.frames.push_back(frame);
  }
  const BoneLengthsById bones = MeasureBones(sequence, {});
  ASSERT_EQ(bones.size(), 2U);
  for (size_t i = 1; i < kJointCount; ++i) EXPECT_NEAR(bones.at(4)[i], bones.at(9)[i], 1e-3) << i;
}

// Files have arbitrary positions for unseen joints: here the camera itself, 2.5 m away.
TEST(ButterworthSequence, IgnoresUntrackedJoints) {
  SkeletonSequence sequence = Recording(60, {1});
  for (int f = 28; f < 32; ++f) {
    JointRecord& hand = *sequence.frames[static_cast<size_t>(f)].bodies[0].joints[kHand];
    hand.state = TrackingState::kNotTracked;
    hand.position_m.setZero();
  }
  const auto made = ButterworthSequence(sequence);
  for (size_t f = 0; f < 60; ++f) {
    const auto& hand = made.frames[f].bodies[0].joints[kHand];
    ASSERT_EQ(hand.has_value(), f < 28 || f >= 32) << f;
    if (!hand) continue;
    const Eigen::Vector3d truth_m = At(made.frames[f].time_s).position_m[kHand];
    EXPECT_LT((hand->position_m - truth_m).norm(), 0.02) << f;
  }
}

// Loggers poll faster than the sensor delivers.
TEST(ButterworthSequence, FiltersSequencesWithRepeatedTimes) {
  SkeletonSequence twice = Recording(60, {1});
  for (size_t f = 0; f < 60; ++f) {
    twice.frames[f].bodies[0].joints[kHand]->position_m.y() += f % 2 == 0 ? 0.02 : -0.02;
  }
  for (size_t f = 60; f-- > 0;) {
    const SkeletonFrame again = twice.frames[f];
    twice.frames.insert(twice.frames.begin() + static_cast<ptrdiff_t>(f), again);
  }
  const auto made = ButterworthSequence(twice);
  for (size_t f = 20; f < 100; ++f) {  // ends know one side only
    const Eigen::Vector3d truth_m = At(made.frames[f].time_s).position_m[kHand];
    // At 15 Hz two passes of a filter of 6 Hz leave a fortieth.
    EXPECT_LT((made.frames[f].bodies[0].joints[kHand]->position_m - truth_m).norm(), 0.01) << f;
  }
}

// Samples around an absence are not consecutive.
TEST(ButterworthSequence, RestartsAfterAnAbsence) {
  SkeletonSequence sequence = Recording(120, {1});
  sequence.frames.erase(sequence.frames.begin() + 30, sequence.frames.begin() + 90);
  SkeletonSequence second = sequence;
  second.frames.erase(second.frames.begin(), second.frames.begin() + 30);
  const auto whole = ButterworthSequence(sequence), alone = ButterworthSequence(second);
  for (size_t f = 0; f < 30; ++f) {
    EXPECT_EQ(whole.frames[30 + f].bodies[0].joints[kHand]->position_m,
              alone.frames[f].bodies[0].joints[kHand]->position_m);
  }
}

}  // namespace
}  // namespace ossa::recon
