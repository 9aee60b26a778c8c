// Of a person of whom a few joints are measured, and not the trunk: the rest stays with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "recon/methods/method_table.h"
#include "recon/methods/reconstructor.h"
#include "recon/methods/sequence.h"
#include "recon/skeleton_sequence.h"
#include "tests/recon/synthetic_motion.h"

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

std::vector<std::string> MethodsWithoutLearning() {
  std::vector<std::string> names;
  for (const MethodInfo& method : MethodTable()) {
    if (method.learned != Reads::kRequired) names.emplace_back(method.name);
  }
  return names;
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

class UnseenTrunk : public testing::TestWithParam<std::tuple<std::string, Measured>> {
 protected:
  void SetUp() override {
    static const auto database =
        std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
    ReconstructorOptions options;
    options.method = std::get<0>(GetParam());
    options.database = database;
    options.local_pca.steps = 3;  // for speed: the search is not what is tested
    options.local_pca.samples = 20;
    recorded_ = Record(std::get<1>(GetParam()).joints);
    made_ = ReconstructSequence(recorded_, options);
  }
  SkeletonSequence recorded_, made_;
};

// Hips drifted 2.7 m away from walking knees in ten seconds.
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

TEST_P(UnseenTrunk, MovesNoMeasuredJointThatIsCalledTracked) {
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
                         testing::Combine(testing::ValuesIn(MethodsWithoutLearning()),
                                          testing::ValuesIn(kSubsets)),
                         [](const auto& info) {
                           std::string name = std::get<0>(info.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name + "_" + std::get<1>(info.param).name;
                         });

}  // namespace
}  // namespace ossa::recon
