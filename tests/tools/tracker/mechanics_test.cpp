#include <gtest/gtest.h>

#include "recon/body/standard_body.h"
#include "tools/tracker/mechanics_internal.h"

namespace ossa::tracker {
namespace {

using recon::Joint;

TEST(Mechanics, AFootNobodySeesStaysWhereTheReconstructionPutIt) {
  // Two metres before the sensor, and the feet stretched out, which a hanging foot would not be.
  recon::Posture standing = recon::StandardPosture(recon::RigPose{});
  for (auto& p : standing.position_m) p.z() += 2.0;
  std::array<double, recon::kJointCount> trust;
  trust.fill(1.0);
  for (const Joint foot : {Joint::kFootLeft, Joint::kFootRight})
    trust[static_cast<size_t>(recon::Index(foot))] = 0.0;
  Mechanics mechanics{MechanicsBuild{}};
  std::optional<physics::FilteredPosture> made;
  for (int i = 1; i <= 60; ++i) made = mechanics.Follow(standing, trust, std::nullopt, i / 30.0);
  ASSERT_TRUE(made.has_value());
  for (const Joint foot : {Joint::kFootLeft, Joint::kFootRight}) {
    // A quarter of the foot's length: the character is pulled, not placed.
    EXPECT_LT((made->posture[foot] - standing[foot]).norm(), 0.04) << recon::NameOf(foot);
  }
}

}  // namespace
}  // namespace ossa::tracker
