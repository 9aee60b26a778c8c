// A few measured joints without the trunk: the rest of the body stays with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "recon/methods/method_table.h"
#include "recon/methods/reconstruct_sequence.h"
#include "recon/methods/reconstructor.h"
#include "recon/models/learned_models.h"
#include "recon/skeleton_sequence.h"
#include "tests/recon/synthetic_motion.h"
#include "tests/support/places.h"

namespace ossa::recon {
namespace {

using Joints = std::vector<Joint>;

struct Measured {
  const char* name;
  Joints joints;
};

void PrintTo(const Measured& measured, std::ostream* out) { *out << measured.name; }

const Measured kSubsets[] = {
    {"KneesAndAnkles",
     {Joint::kKneeLeft, Joint::kAnkleLeft, Joint::kKneeRight, Joint::kAnkleRight}},
    {"Knees", {Joint::kKneeLeft, Joint::kKneeRight}},
    {"OneAnkle", {Joint::kAnkleLeft}},
    {"Hands", {Joint::kHandLeft, Joint::kHandRight}},
    {"OneArm", {Joint::kElbowRight, Joint::kWristRight, Joint::kHandRight}},
    {"Elbows", {Joint::kElbowLeft, Joint::kElbowRight}},
    {"Head", {Joint::kHead}},
    {"HandsAndFeet", {Joint::kHandLeft, Joint::kHandRight, Joint::kFootLeft, Joint::kFootRight}},
    {"OneHipAndHead", {Joint::kHipLeft, Joint::kHead}},
    {"Shoulder", {Joint::kShoulderLeft}}};

/// Learned from a gesturing person whose left wrist and hand a sensor sees 5 cm too low.
std::shared_ptr<const LearnedModels> LowHand() {
  std::vector<PosturePair> pairs;
  for (int f = 0; f < 60; ++f) {
    PosturePair& pair = pairs.emplace_back();
    pair.observed = test::Motion(f / 10.0);
    pair.known.fill(1.0);
    pair.residual.position_m[Index(Joint::kWristLeft)].y() = 0.05;
    pair.residual.position_m[Index(Joint::kHandLeft)].y() = 0.05;
  }
  LearnOptions options;
  options.mixture.regions = 3;
  options.mixture.samples = 15;
  options.full_samples = 40;
  options.correction.centres = 5;
  return std::make_shared<const LearnedModels>(LearnedModels::Learn(pairs, options));
}

/// Ten seconds of somebody who gestures and walks off, 0.5 m/s, of whom these joints are measured.
SkeletonSequence Record(const Joints& joints) {
  SkeletonSequence sequence{"walk", {}};
  for (int f = 0; f < 300; ++f) {
    SkeletonFrame& frame = sequence.frames.emplace_back();
    frame.frame = f;
    frame.time_s = f / 30.0;
    Posture posture = test::InFrontOfCamera(test::Motion(frame.time_s));
    for (auto& p : posture.position_m) p.x() += 0.5 * frame.time_s;
    BodyRecord& body = frame.bodies.emplace_back();
    body.id = 1;
    for (const Joint joint : joints) {
      body.joints[joint].emplace().position_m = posture[joint];
    }
  }
  return sequence;
}

/// Length of the standard body's bones on the way from one joint to another.
double ChainBetween_m(size_t a, size_t b) {
  const BoneLengths& bones = StandardBoneLengths();
  double length_m = 0.0;
  while (a != b) {  // parents come before children
    size_t& below = a > b ? a : b;
    length_m += bones[below];
    below = ParentOf(below);
  }
  return length_m;
}

ReconstructorOptions OptionsFor(const std::string& method) {
  static const auto database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  static const auto learned = LowHand();
  ReconstructorOptions options;
  options.method = method;
  options.database = database;
  if (RequireMethod(method).learned == Reads::kRequired) options.learned = learned;
  options.gaussian_process.incremental = false;
  options.local_pca.steps = 3;  // for speed: the search is not what is tested
  options.local_pca.samples = 20;
  return options;
}

class UnseenTrunk : public testing::TestWithParam<std::tuple<std::string, Measured>> {
 protected:
  void SetUp() override {
    recorded_ = Record(std::get<1>(GetParam()).joints);
    made_ = ReconstructSequence(recorded_, OptionsFor(std::get<0>(GetParam())));
  }
  SkeletonSequence recorded_, made_;
};

// Hips must not drift away from walking knees.
TEST_P(UnseenTrunk, StaysWithinReachOfTheMeasuredJoints) {
  constexpr double kSlack = 1.35;    // of the bones' lengths: another person's, and a guess
  constexpr double kSlack_m = 0.05;  // of filters that lag
  for (size_t f = 0; f < made_.frames.size(); f += 7) {
    const BodyRecord& made = made_.frames[f].bodies.at(0);
    const BodyRecord& seen = recorded_.frames[f].bodies.at(0);
    for (size_t j = 0; j < kJointCount; ++j) {
      if (seen.joints[j]) continue;
      double room_m = -1e9;
      for (size_t m = 0; m < kJointCount; ++m) {
        if (!seen.joints[m]) continue;
        const double far_m = (made.joints[j]->position_m - seen.joints[m]->position_m).norm();
        room_m = std::max(room_m, kSlack * ChainBetween_m(j, m) + kSlack_m - far_m);
      }
      ASSERT_GE(room_m, 0.0) << kJointNames[j] << " of frame " << f;
    }
  }
}

TEST_P(UnseenTrunk, MovesTrackedJointsLittle) {
  constexpr double kStays_m = 0.15;
  for (size_t f = 0; f < made_.frames.size(); ++f) {
    const BodyRecord& made = made_.frames[f].bodies.at(0);
    const BodyRecord& seen = recorded_.frames[f].bodies.at(0);
    for (size_t j = 0; j < kJointCount; ++j) {
      if (!seen.joints[j] || made.joints[j]->state != TrackingState::kTracked) continue;
      ASSERT_LT((made.joints[j]->position_m - seen.joints[j]->position_m).norm(), kStays_m)
          << kJointNames[j] << " of frame " << f;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryMethod, UnseenTrunk,
                         testing::Combine(testing::ValuesIn(ReconstructionMethods()),
                                          testing::ValuesIn(kSubsets)),
                         [](const auto& info) {
                           std::string name = std::get<0>(info.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + "_" + std::get<1>(info.param).name;
                         });

/// All joints but these.
Joints AllBut(const Joints& absent) {
  Joints joints;
  for (size_t j = 0; j < kJointCount; ++j) {
    const auto joint = static_cast<Joint>(j);
    if (std::count(absent.begin(), absent.end(), joint) == 0) joints.push_back(joint);
  }
  return joints;
}

class UnseenHandOrWrist : public UnseenTrunk {};

// Joints that files do not have, such as hands (UI-PRMD) or wrists (ITOP, NiTE), must follow the
// arm.
TEST_P(UnseenHandOrWrist, StaysNearTheArm) {
  constexpr double kSlack = 1.35;    // of the bones' lengths: another person's, and a guess
  constexpr double kSlack_m = 0.05;  // of filters that lag
  for (size_t f = 0; f < made_.frames.size(); f += 7) {
    const auto& made = made_.frames[f].bodies.at(0).joints;
    for (const Joint joint :
         {Joint::kWristLeft, Joint::kHandLeft, Joint::kWristRight, Joint::kHandRight}) {
      const size_t parent = ParentOf(Index(joint));
      ASSERT_LT((made[joint]->position_m - made[parent]->position_m).norm(),
                kSlack * StandardBoneLengths()[joint] + kSlack_m)
          << kJointNames[joint] << " of frame " << f;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    OfEveryMethod, UnseenHandOrWrist,
    testing::Combine(
        testing::ValuesIn(ReconstructionMethods()),
        testing::Values(Measured{"NoHands", AllBut({Joint::kHandLeft, Joint::kHandRight})},
                        Measured{"NoWrists", AllBut({Joint::kWristLeft, Joint::kWristRight})})),
    [](const auto& info) {
      std::string name = std::get<0>(info.param);
      std::replace(name.begin(), name.end(), '-', '_');
      return name + "_" + std::get<1>(info.param).name;
    });

// Ten seconds of walking with markers on knees and ankles only.
class MarkedKneesAndAnkles : public testing::TestWithParam<std::string> {};

TEST_P(MarkedKneesAndAnkles, HipsStayWithinALegOfThemAndTheyWhereTheyWereMarked) {
  const auto path = ossa::test::SharedFolder() / "cases/trc/knees_ankles_walk.trc";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "not here: " << path;
  const SkeletonSequence marked = ReadSkeletons(path);
  ASSERT_EQ(marked.frames.size(), 300u);
  const SkeletonSequence made = ReconstructSequence(marked, OptionsFor(GetParam()));
  constexpr double kLeg_m = 1.0;      // thigh and half a pelvis, of a tall person
  constexpr double kMarked_m = 0.08;  // the one euro filter lags 6 cm behind an ankle that swings
  for (size_t f = 0; f < marked.frames.size(); ++f) {
    const auto& seen = marked.frames[f].bodies.at(0).joints;
    const auto& there = made.frames[f].bodies.at(0).joints;
    for (const Joint knee : {Joint::kKneeLeft, Joint::kKneeRight}) {
      const auto hip = static_cast<Joint>(Index(knee) - 1);
      EXPECT_LT((there[hip]->position_m - seen[knee]->position_m).norm(), kLeg_m) << f;
    }
    for (size_t j = 0; j < kJointCount; ++j) {
      if (!seen[j] || there[j]->state != TrackingState::kTracked) continue;
      EXPECT_LT((there[j]->position_m - seen[j]->position_m).norm(), kMarked_m)
          << kJointNames[j] << " of frame " << f;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryMethod, MarkedKneesAndAnkles,
                         testing::ValuesIn(ReconstructionMethods()), [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace ossa::recon
