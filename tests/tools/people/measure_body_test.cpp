// Body measures between confident joints: synthetic joints, no forest.
#include "tools/people/measure_body.h"

#include <gtest/gtest.h>

#include "tests/support/capsule_person.h"
#include "tests/tools/people/evidence.h"

namespace ossa::people {
namespace {

using recon::Joint;

TEST(MeasureBody, LeavesOutImplausibleLimbs) {
  recon::Posture joints = tests::ComputeJoints(tests::CapsulePose{});
  const auto thigh_m = [&] {
    const auto body = MeasureBody(MakeSureEvidence(joints), OneTargetPerJoint(), std::nullopt);
    return body[static_cast<size_t>(Measure::kThigh)];
  };
  ASSERT_TRUE(thigh_m());
  // A partly occluded knee is placed where the visible part of the thigh ends.
  for (const auto& [hip, knee] :
       {std::pair(Joint::kHipLeft, Joint::kKneeLeft), {Joint::kHipRight, Joint::kKneeRight}}) {
    joints[knee] = joints[hip] + 0.3 * (joints[knee] - joints[hip]);
  }
  EXPECT_FALSE(thigh_m());
}

}  // namespace
}  // namespace ossa::people
