#include <gtest/gtest.h>

#include "recon/methods/reconstructor.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

std::unique_ptr<Reconstructor> Plantard2016() {
  static const auto database =
      std::make_shared<PostureDatabase>(PostureDatabase::Build(test::GestureClips(), {}));
  ReconstructorOptions options;
  options.method = "plantard-2016";
  options.database = database;
  return MakeReconstructor(options);
}

constexpr size_t kLeftHand = 7;

// Sc of sec. 6.1: for a hidden arm the similarity Ss is equal for all positions; continuity selects
// the last one.
TEST(Plantard2016, KeepsAHiddenArmAsItWas) {
  const auto method = Plantard2016();
  const Posture truth = test::InFrontOfCamera(test::Gesture(1.5, 0.5, 0.3));
  TrackedPosture seen = test::AllTracked(truth);
  for (int f = 0; f < 10; ++f) method->Step({seen, f / 30.0, nullptr});
  for (const size_t joint : {size_t{5}, size_t{6}, kLeftHand}) {
    seen.state[joint] = TrackingState::kNotTracked;
  }
  Posture made;
  for (int f = 10; f < 20; ++f) made = method->Step({seen, f / 30.0, nullptr}).posture;
  // The database's postures are 20 cm apart; hanging, the hand would be a metre away.
  EXPECT_LT((made.position_m[kLeftHand] - truth.position_m[kLeftHand]).norm(), 0.2);
}

// Sec. 6.2 searches the neighbours of the nodes used last; where none of them resembles what is
// seen any more, all nodes are searched at once (a departure).
TEST(Plantard2016, FindsAPostureFarFromTheLastOneInOneFrame) {
  const auto method = Plantard2016();
  const Posture hanging = test::InFrontOfCamera(test::Gesture(0.1, 0.1, 0.0));
  const Posture raised = test::InFrontOfCamera(test::Gesture(1.75, 1.75, 1.2, 0.8));
  for (int f = 0; f < 10; ++f) method->Step({test::AllTracked(hanging), f / 30.0, nullptr});
  const Posture made = method->Step({test::AllTracked(raised), 10 / 30.0, nullptr}).posture;
  EXPECT_LT(test::MeanDistance_m(made, raised), 0.1);  // half the spacing of the database
}

}  // namespace
}  // namespace ossa::recon
