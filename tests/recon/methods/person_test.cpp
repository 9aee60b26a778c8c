#include <gtest/gtest.h>

#include "recon/methods/person_internal.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon {
namespace {

// What the database is asked for must be where the hand is, whoever's arm it is on and whatever the
// hidden elbow is guessed to do.
TEST(Person, KeepsTheReachOfAHandWhoseArmIsHidden) {
  for (const double scale : {0.6, 1.0, 1.3}) {
    Person person;
    const Posture before = test::Gesture(0.2, 0.2, 0.1), now = test::Gesture(1.6, 0.2, 0.8);
    person.Prepare({test::AllTracked(test::InFrontOfCamera(before, scale)), 0.0, nullptr});
    TrackedPosture seen = test::AllTracked(test::InFrontOfCamera(now, scale));
    seen.state[5] = seen.state[6] = TrackingState::kNotTracked;  // elbow and wrist
    const PreparedPosture prepared = person.Prepare({seen, 1.0 / 30, nullptr});
    // The person is the standard one scaled: bones are known from the first frame exactly.
    EXPECT_LT((prepared.normalised.position_m[7] - now.position_m[7]).norm(), 1e-3) << scale;
    EXPECT_EQ(prepared.reliability[5], 0.0);
  }
}

TEST(Person, TakesTrunkBonesAsTheSensorHasThem) {
  Person person;
  Posture posture = test::InFrontOfCamera(test::Gesture(0.2, 0.2, 0.1));
  const Eigen::Vector3d up = posture[Joint::kSpine] - posture[Joint::kHipCenter];
  posture[Joint::kSpine] += 0.1 * up.normalized();
  const PreparedPosture prepared = person.Prepare({test::AllTracked(posture), 0.0, nullptr});
  const Posture back = person.InCamera(prepared.normalised, prepared);
  // There and back is the same posture, not one with a spine of the standard length.
  for (size_t i = 0; i < kJointCount; ++i) {
    EXPECT_LT((back.position_m[i] - posture.position_m[i]).norm(), 1e-3) << kJointNames[i];
  }
}

}  // namespace
}  // namespace ossa::recon
