// Fusion of skeletons of several cameras: the more accurate camera decides.
#include "recon/fuse/fuse_skeletons.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <vector>

#include "tests/recon/fuse/moving_people.h"

namespace ossa::recon {
namespace {

using test::FromTheSide;
using test::MadeUpCamera;
using test::Record;
using test::WalkerAt;

const std::vector<double> kOnePerson = {0.0}, kTwoPeople = {0.0, 4.0};
constexpr size_t kHand = Index(Joint::kHandLeft);

Extrinsics Room(double clock_offset_s = 0.0) {
  return {{.name = "front"}, {"side", FromTheSide(), clock_offset_s}};
}

SkeletonSequence Fused(const SkeletonSequence& a, const SkeletonSequence& b,
                       double clock_offset_s = 0.0, const FuseOptions& options = {}) {
  const std::vector<SkeletonSequence> both = {a, b};
  return FuseSkeletons(both, Room(clock_offset_s), options);
}

Eigen::Vector3d PlaceOf(const SkeletonFrame& frame, size_t body, size_t joint) {
  return frame.bodies.at(body).joints[joint]->position_m;
}

double RootMeanSquare_m(const SkeletonSequence& sequence) {
  double sum = 0.0;
  for (const SkeletonFrame& frame : sequence.frames) {
    const Posture truth = WalkerAt(frame.time_s);
    for (size_t j = 0; j < kJointCount; ++j) {
      sum += (PlaceOf(frame, 0, j) - truth.position_m[j]).squaredNorm();
    }
  }
  return std::sqrt(sum / static_cast<double>(sequence.frames.size() * kJointCount));
}

void MoveHand(SkeletonSequence& sequence, const Eigen::Vector3d& by_m, TrackingState state,
              double confidence) {
  for (SkeletonFrame& frame : sequence.frames) {
    JointRecord& hand = *frame.bodies[0].joints[kHand];
    hand.position_m += by_m;
    hand.state = state;
    hand.confidence = confidence;
  }
}

TEST(FuseSkeletons, InterpolatesToTheFirstCamerasTimesForAnyClock) {
  auto front = Record({}, kOnePerson, 60);
  front.frames.erase(front.frames.begin() + 20, front.frames.begin() + 25);
  for (auto& frame : front.frames) frame.floor = Eigen::Vector4d(0, 1, 0, 0.9);
  const auto fused = Fused(front, Record({FromTheSide(), 0.2}, kOnePerson, 60), 0.2);
  ASSERT_EQ(fused.frames.size(), front.frames.size());
  for (size_t f = 0; f < front.frames.size(); ++f) {
    EXPECT_EQ(fused.frames[f].time_s, front.frames[f].time_s);
    EXPECT_EQ(fused.frames[f].frame, front.frames[f].frame);
    EXPECT_TRUE(fused.frames[f].floor);
  }
  // Linear between frames: 1/8 of the acceleration (some 3 m/s^2) times the step squared.
  EXPECT_LT(RootMeanSquare_m(fused), 1e-3);
}

TEST(FuseSkeletons, HalvesTheVarianceOfTwoEqualCameras) {
  FuseOptions options;
  options.keep_bones = false;
  const auto front = Record({.noise_m = 0.02, .seed = 5}, kOnePerson, 200);
  const auto side = Record({FromTheSide(), 0.0, 0.02, 6}, kOnePerson, 200);
  // Weights follow the rays, the made-up noise does not: between sqrt(1/2) and 1.
  EXPECT_NEAR(RootMeanSquare_m(Fused(front, side, 0.0, options)) / RootMeanSquare_m(front), 0.75,
              0.05);
}

TEST(FuseSkeletons, TrustsTheCameraThatSeesTheDirectionSideways) {
  // One joint, off along camera 0's ray; the side camera, square to it, has it right.
  SkeletonSequence front{"front", {SkeletonFrame{}}}, side = front;
  const Eigen::Vector3d truth_m(0.0, 0.0, 3.0), off_m(0.0, 0.0, 0.08);
  BodyRecord& a = front.frames[0].bodies.emplace_back();
  a.joints[kHand].emplace().position_m = truth_m + off_m;
  BodyRecord& b = side.frames[0].bodies.emplace_back();
  Eigen::Isometry3d square = Eigen::Isometry3d::Identity();
  square.linear() =
      Eigen::AngleAxisd(-0.5 * 3.14159265358979, Eigen::Vector3d::UnitY()).toRotationMatrix();
  square.translation() = Eigen::Vector3d(3.0, 0.0, 3.0);
  b.joints[kHand].emplace().position_m = square * truth_m;
  ASSERT_NEAR((square * truth_m).x(), 0.0, 1e-9);  // on its own axis
  const std::vector<SkeletonSequence> both = {front, side};
  const auto fused = FuseSkeletons(both, {{.name = "front"}, {"side", square, 0.0}});
  // Variances along and across are as 9 to 4; the wrong one weighs 4 of 13.
  EXPECT_NEAR((PlaceOf(fused.frames[0], 0, kHand) - truth_m).z(), 0.08 * 4.0 / 13.0, 1e-6);
}

TEST(FuseSkeletons, UsesStandardDeviationsInTheirCamerasAxes) {
  auto front = Record({}, kOnePerson, 2), side = Record({FromTheSide()}, kOnePerson, 2);
  for (auto& frame : front.frames) {
    for (auto& joint : frame.bodies[0].joints) {
      joint->position_m.x() += 0.1;
      joint->sigma_m = Eigen::Vector3d(0.3, 0.01, 0.01);
    }
  }
  for (auto& frame : side.frames) {
    for (auto& joint : frame.bodies[0].joints) joint->sigma_m = Eigen::Vector3d::Constant(0.01);
  }
  const auto fused = Fused(front, side);
  // Some of x leaks where the weights' axes differ; none does here: the side's are equal.
  EXPECT_NEAR(PlaceOf(fused.frames[0], 0, kHand).x(), WalkerAt(0.0).position_m[kHand].x(), 1e-3);
  EXPECT_NEAR(fused.frames[0].bodies[0].joints[kHand]->sigma_m->x(), 0.01, 1e-4);
}

TEST(FuseSkeletons, PrefersTrackedJointsOverInferredOnes) {
  auto front = Record({}, kOnePerson, 30);
  MoveHand(front, {0.1, 0.05, 0.0}, TrackingState::kInferred, 0.9);
  const auto fused = Fused(front, Record({FromTheSide()}, kOnePerson, 30));
  EXPECT_LT(RootMeanSquare_m(fused), 1e-6);
  EXPECT_EQ(fused.frames[3].bodies[0].joints[kHand]->state, TrackingState::kTracked);
}

TEST(FuseSkeletons, TakesTheMoreConfidentOfDistantTrackedJoints) {
  auto front = Record({}, kOnePerson, 30);
  MoveHand(front, {0.5, 0.0, 0.0}, TrackingState::kTracked, 0.4);
  EXPECT_LT(RootMeanSquare_m(Fused(front, Record({FromTheSide()}, kOnePerson, 30))), 1e-6);
}

TEST(FuseSkeletons, IgnoresALimbThatOneCameraConfusesForAWhile) {
  auto front = Record({}, kOnePerson, 60), side = Record({FromTheSide()}, kOnePerson, 60);
  MoveHand(front, {0.0, 0.0, 0.0}, TrackingState::kTracked, 0.6);
  MoveHand(side, {0.0, 0.0, 0.0}, TrackingState::kTracked, 0.6);
  for (size_t f = 30; f < 35; ++f) {
    front.frames[f].bodies[0].joints[kHand]->state = TrackingState::kInferred;
    side.frames[f].bodies[0].joints[kHand]->position_m.y() -= 0.6;
  }
  EXPECT_LT(RootMeanSquare_m(Fused(front, side)), 1e-6);
}

TEST(FuseSkeletons, FollowsTheTwoAgreeingCamerasOfThree) {
  auto front = Record({}, kOnePerson, 10);
  MoveHand(front, {0.5, 0.0, 0.0}, TrackingState::kTracked, 1.0);
  auto side = Record({FromTheSide()}, kOnePerson, 10);
  MoveHand(side, {0.0, 0.0, 0.0}, TrackingState::kTracked, 0.5);
  const std::vector<SkeletonSequence> three = {front, side, side};
  auto cameras = Room();
  cameras.push_back({"again", FromTheSide(), 0.0});
  EXPECT_LT(RootMeanSquare_m(FuseSkeletons(three, cameras)), 1e-6);
}

TEST(FuseSkeletons, KeepsPeopleSeenByOneCamera) {
  const std::vector<double> other = {4.0};
  const auto fused = Fused(Record({}, kOnePerson, 30), Record({FromTheSide()}, other, 30));
  for (const SkeletonFrame& frame : fused.frames) {
    ASSERT_EQ(frame.bodies.size(), 2u);
    EXPECT_EQ(frame.bodies[0].id, 1);
    EXPECT_EQ(frame.bodies[1].id, 2);
    const Posture second = WalkerAt(frame.time_s, 4.0);
    EXPECT_LT((PlaceOf(frame, 1, kHand) - second.position_m[kHand]).norm(), 1e-9);
  }
}

TEST(FuseSkeletons, KeepsAnIdWhileOneCameraLosesThePerson) {
  auto front = Record({}, kTwoPeople, 90), side = Record({FromTheSide()}, kTwoPeople, 90);
  for (auto& frame : side.frames) std::swap(frame.bodies[0].id, frame.bodies[1].id);
  for (size_t f = 30; f < 90; ++f) front.frames[f].bodies[0].id = 7;  // found again as another
  for (size_t f = 20; f < 40; ++f) front.frames[f].bodies.erase(front.frames[f].bodies.begin());
  for (size_t f = 50; f < 90; ++f) side.frames[f].bodies.clear();
  std::set<int> ids;
  for (const SkeletonFrame& frame : Fused(front, side).frames) {
    EXPECT_EQ(frame.bodies.size(), 2u);
    for (const BodyRecord& body : frame.bodies) ids.insert(body.id);
  }
  EXPECT_EQ(ids, (std::set<int>{1, 2}));
}

// As point formats represent a lost person.
void LosePlaces(SkeletonSequence& sequence, size_t begin, size_t end) {
  for (size_t f = begin; f < end; ++f) {
    for (auto& joint : sequence.frames[f].bodies[0].joints) {
      if (f % 2 == 0) joint.reset();
      if (!joint) continue;
      joint = JointRecord();
      joint->state = TrackingState::kNotTracked;
    }
  }
}

TEST(FuseSkeletons, IgnoresBodiesWithoutPosition) {
  for (const bool first_loses : {true, false}) {
    auto front = Record({}, kOnePerson, 60), side = Record({FromTheSide()}, kOnePerson, 60);
    LosePlaces(first_loses ? front : side, 20, 40);
    const auto fused = Fused(front, side);
    for (const SkeletonFrame& frame : fused.frames) {
      ASSERT_EQ(frame.bodies.size(), 1u) << frame.frame;
      EXPECT_EQ(frame.bodies[0].id, 1);
    }
    EXPECT_LT(RootMeanSquare_m(fused), 1e-6);
  }
}

TEST(FuseSkeletons, WarnsOfARecordingWithoutCommonTimes) {
  const auto front = Record({}, kOnePerson, 30, "front.jsonl");
  const auto side = Record({FromTheSide()}, kOnePerson, 30, "side.jsonl");
  EXPECT_TRUE(Fused(front, side, 0.5).warnings.empty());
  const auto apart = Fused(front, side, -100.0);
  ASSERT_EQ(apart.warnings.size(), 1u);
  EXPECT_TRUE(apart.warnings[0].starts_with("side.jsonl: by its clock offset, -100.000 s"))
      << apart.warnings[0];
}

TEST(FuseSkeletons, IgnoresCamerasThatSeeNobodyAtTheTime) {
  auto side = Record({FromTheSide()}, kOnePerson, 60);
  for (size_t f = 20; f < 40; ++f) side.frames[f].bodies.clear();
  auto front = Record({}, kOnePerson, 60);
  MoveHand(front, {0.1, 0.0, 0.0}, TrackingState::kInferred, 0.9);
  FuseOptions options;
  options.keep_bones = false;
  const auto fused = Fused(front, side, 0.0, options);
  const auto hand_off = [&](size_t f) {
    return (PlaceOf(fused.frames[f], 0, kHand) -
            WalkerAt(static_cast<double>(f) / 30.0).position_m[kHand])
        .norm();
  };
  EXPECT_LT(hand_off(19), 1e-9);
  EXPECT_NEAR(hand_off(30), 0.1, 1e-9);
  EXPECT_LT(hand_off(40), 1e-9);
}

TEST(FuseSkeletons, UsesEachRecordingsOwnFrames) {
  auto front = Record({}, kOnePerson, 30), side = Record({FromTheSide()}, kOnePerson, 30);
  std::erase_if(side.frames, [](const SkeletonFrame& frame) { return frame.frame % 5 != 0; });
  MoveHand(front, {0.09, 0.0, 0.0}, TrackingState::kInferred, 0.9);
  const auto fused = Fused(front, side);  // six frames a second, 0.17 s apart
  for (size_t f = 0; f < 25; ++f) {
    EXPECT_EQ(fused.frames[f].bodies[0].joints[kHand]->state, TrackingState::kTracked) << f;
  }
}

TEST(FuseSkeletons, KeepsBoneLengths) {
  const auto fused = Fused(Record({.noise_m = 0.02, .seed = 5}, kOnePerson, 60),
                           Record({FromTheSide(), 0.0, 0.02, 6}, kOnePerson, 60));
  const auto first = MeasureBoneLengths(ToTrackedPosture(fused.frames[0].bodies[0]).posture);
  const auto last = MeasureBoneLengths(ToTrackedPosture(fused.frames[59].bodies[0]).posture);
  for (size_t j = 1; j < kJointCount; ++j) EXPECT_NEAR(first[j], last[j], 1e-6);
}

TEST(FuseSkeletons, OneRecordingStaysUnchanged) {
  const std::vector<SkeletonSequence> one = {Record({.noise_m = 0.02}, kOnePerson, 5)};
  const auto fused = FuseSkeletons(one, {{.name = "front"}});
  EXPECT_EQ(PlaceOf(fused.frames[3], 0, kHand), PlaceOf(one[0].frames[3], 0, kHand));
  EXPECT_THROW(FuseSkeletons(one, Room()), std::invalid_argument);
}

}  // namespace
}  // namespace ossa::recon
