// Estimates camera poses from synthetic walking people, with known transform and clock offset.
#include "recon/fuse/estimate_extrinsics.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "depth/base/angles.h"
#include "depth/base/error.h"
#include "recon/fuse/rigid_alignment_internal.h"
#include "tests/recon/fuse/moving_people.h"

namespace ossa::recon {
namespace {

using test::FromTheSide;
using test::MadeUpCamera;
using test::Record;

constexpr double kFrame_s = 1.0 / 30;
const std::vector<double> kOne = {0.0}, kTwo = {0.0, 4.0};

void ExpectFound(const CameraEstimate& found, const MadeUpCamera& truth, double shift_m,
                 double turn_deg, double clock_s) {
  const Eigen::Isometry3d off = found.camera.from_camera_0 * truth.from_camera_0.inverse();
  // Where the people are, three metres away, rather than at the camera.
  const Eigen::Vector3d person_m(0.0, 0.0, 3.0);
  EXPECT_LT((off * person_m - person_m).norm(), shift_m);
  EXPECT_LT(Eigen::AngleAxisd(off.linear()).angle(), turn_deg * kDegree);
  EXPECT_NEAR(found.camera.clock_offset_s, truth.clock_offset_s, clock_s);
}

std::string SaidOf(const SkeletonSequence& a, const SkeletonSequence& b) {
  try {
    EstimateCamera(a, b);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RigidAlignment, IsExactForThreePoints) {
  RigidAlignment alignment;
  const Eigen::Isometry3d truth = FromTheSide();
  for (const Eigen::Vector3d& point_m :
       {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 2), Eigen::Vector3d(0, 1, 3)}) {
    alignment.Add(point_m, truth * point_m, 0.7);
  }
  const auto found = alignment.Solve();
  EXPECT_TRUE(found.to_from_from.isApprox(truth, 1e-9));  // rounding
  EXPECT_NEAR(found.mean_square_m2, 0.0, 1e-12);
}

TEST(RigidAlignment, NeverReflects) {
  RigidAlignment alignment;
  for (const Eigen::Vector3d& point_m : {Eigen::Vector3d(0, 0, 2), Eigen::Vector3d(1, 0, 2),
                                         Eigen::Vector3d(0, 1, 3), Eigen::Vector3d(1, 2, 1)}) {
    alignment.Add(point_m, Eigen::Vector3d(-point_m.x(), point_m.y(), point_m.z()), 1.0);
  }
  EXPECT_NEAR(alignment.Solve().to_from_from.linear().determinant(), 1.0, 1e-9);
}

TEST(EstimateCamera, FindsTransformAndClockThroughNoise) {
  const MadeUpCamera front{.noise_m = 0.03, .seed = 2};
  const MadeUpCamera side{FromTheSide(), 1.27, 0.03, 3};
  const auto found = EstimateCamera(Record(front, kOne, 240), Record(side, kOne, 240));
  ExpectFound(found, side, 0.02, 1.0, kFrame_s);
  // 3 cm along each of three axes of both cameras: the median of |N(0, 2 * 0.03^2)| in space is
  // 1.54 times 4.2 cm, less what interpolation smooths.
  EXPECT_NEAR(found.disagreement_m, 0.062, 0.01);
  EXPECT_NEAR(found.common_s, 8.0 - 1.27, 0.2);
}

TEST(EstimateCamera, FindsTwoPeopleWhoseIdsAreSwapped) {
  const MadeUpCamera side{FromTheSide(), -0.4, 0.02, 3};
  auto second = Record(side, kTwo, 200);
  for (auto& frame : second.frames) std::swap(frame.bodies[0].id, frame.bodies[1].id);
  const auto found = EstimateCamera(Record({.noise_m = 0.02}, kTwo, 200), second);
  ExpectFound(found, side, 0.02, 1.0, kFrame_s);
}

TEST(EstimateCamera, FindsTheOnlyPersonSeenByBoth) {
  const MadeUpCamera side{FromTheSide(), 0.2, 0.02, 3};
  const std::vector<double> others = {9.0, 0.0};
  const auto found =
      EstimateCamera(Record({.noise_m = 0.02}, kTwo, 200), Record(side, others, 200));
  ExpectFound(found, side, 0.02, 1.0, kFrame_s);
}

TEST(EstimateCamera, FindsLargeClockOffsets) {
  MadeUpCamera side{FromTheSide(), 0.3, 0.01, 3};
  auto second = Record(side, kOne, 150);
  for (auto& frame : second.frames) frame.time_s += 1.6e9;  // since 1970
  side.clock_offset_s -= 1.6e9;
  const auto found = EstimateCamera(Record({}, kOne, 150), second);
  ExpectFound(found, side, 0.02, 1.0, kFrame_s);
}

TEST(EstimateCamera, IsRobustAgainstAWrongArm) {
  const MadeUpCamera side{FromTheSide(), 0.1, 0.01, 3};
  auto second = Record(side, kOne, 150);
  for (auto& frame : second.frames) {
    for (const Joint joint : {Joint::kElbowLeft, Joint::kWristLeft, Joint::kHandLeft}) {
      frame.bodies[0].joints[joint]->position_m += Eigen::Vector3d(0.4, 0.0, 0.0);
    }
  }
  ExpectFound(EstimateCamera(Record({}, kOne, 150), second), side, 0.02, 1.0, kFrame_s);
}

TEST(EstimateCamera, RefusesAmbiguousMotion) {
  const auto moving = Record({}, kOne, 150);
  auto nobody = moving;
  nobody.source = "B.jsonl";
  for (auto& frame : nobody.frames) frame.bodies.clear();
  EXPECT_EQ(SaidOf(moving, nobody).find("B.jsonl: expected a person whom both cameras see moving"),
            0u);
  auto still = moving;
  for (auto& frame : still.frames) frame.bodies = moving.frames[0].bodies;
  EXPECT_NE(SaidOf(still, still).find("joints that move by 0.0 cm"), std::string::npos)
      << SaidOf(still, still);
  auto brief = moving;
  brief.frames.resize(10);
  EXPECT_NE(SaidOf(moving, brief).find("less than half a second"), std::string::npos);
  const std::vector<double> another = {9.0};
  EXPECT_NE(SaidOf(moving, Record({}, another, 150)).find("do not move alike"), std::string::npos)
      << SaidOf(moving, Record({}, another, 150));
}

TEST(EstimateCamera, RefusesMotionThatRepeats) {
  auto swinging = Record({}, kOne, 300);
  for (size_t f = 0; f < swinging.frames.size(); ++f) {
    swinging.frames[f].bodies = swinging.frames[f % 45].bodies;
  }
  EXPECT_NE(SaidOf(swinging, swinging).find("fits as well 1.5"), std::string::npos)
      << SaidOf(swinging, swinging);
}

}  // namespace
}  // namespace ossa::recon
