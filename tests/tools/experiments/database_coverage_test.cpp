#include "tools/experiments/papers/database_coverage.h"

#include <gtest/gtest.h>

#include <numbers>

#include "recon/database/posture_database.h"

namespace ossa::tools {
namespace {

recon::PostureDatabase OneStandingPosture() {
  return recon::PostureDatabase::Build({{"stand", {recon::StandardStance()}, {}}}, {});
}

RecordedPair Recorded(const recon::Posture& in_camera) {
  recon::BodyRecord body;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    body.joints[j] = recon::JointRecord{};
    body.joints[j]->position_m = in_camera.position_m[j];
  }
  return {"s01/m07_s01_e01", "s01", {"", {{0, 0.0, {}, {body}}}}, {}};
}

TEST(CoverageTable, FindsAPostureAtAnyPlaceAndBodyHeight) {
  const recon::Posture tall = recon::Scaled(recon::StandardStance(), 1.2);
  const auto table = CoverageTable(
      OneStandingPosture(), {Recorded(recon::Placed(tall, {{0.4, 0.2, 3.0}, std::numbers::pi}))});
  ASSERT_EQ(table.rows.size(), 2u);  // all, and the one exercise
  EXPECT_EQ(table.rows[1][0], "m07");
  EXPECT_EQ(table.rows[1][2], "0.00");
}

TEST(CoverageTable, MeasuresTheMeanJointDistanceToTheNearestPosture) {
  recon::Posture raised = recon::StandardStance();
  // A hand rotated by 180 degrees about the wrist moves by twice the length of its bone.
  const recon::Joint hand = recon::Joint::kHandLeft, wrist = recon::Joint::kWristLeft;
  const double bone_m = (raised[hand] - raised[wrist]).norm();
  raised[hand] = 2.0 * raised[wrist] - raised[hand];
  const auto table = CoverageTable(OneStandingPosture(), {Recorded(recon::Placed(raised, {}))});
  EXPECT_NEAR(std::stod(table.rows[1][2]), 100.0 * 2.0 * bone_m / recon::kJointCount,
              0.006);  // two digits are printed
}

}  // namespace
}  // namespace ossa::tools
