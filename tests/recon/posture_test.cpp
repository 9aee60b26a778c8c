#include "recon/posture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "recon/normalise.h"
#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

const Vector3d kNowhere = Vector3d::Constant(std::nan(""));

TEST(FilledPosture, PlacesMissingJointsRelativeToTheirParents) {
  const Posture whole = StandardStance();
  const Vector3d move_m(0.5, -0.1, 2.0);
  Posture seen = whole;
  for (Vector3d& p : seen.position_m) p += move_m;
  seen[Joint::kElbowLeft] = seen[Joint::kWristLeft] = kNowhere;
  const Posture filled = FilledFrom(whole, seen);
  for (size_t j = 0; j < kJointCount; ++j) {
    EXPECT_TRUE(filled.position_m[j].isApprox(whole.position_m[j] + move_m, 1e-12)) << j;
  }
}

TEST(FilledPosture, EqualsTheReferenceIfNothingIsKnown) {
  Posture nothing;
  nothing.position_m.fill(kNowhere);
  EXPECT_LT(MeanDistance_m(FilledFrom(StandardStance(), nothing), StandardStance()), 1e-12);
}

TEST(MeanDistance, AveragesOverKnownJoints) {
  const Posture whole = StandardStance();
  Posture target;
  target.position_m.fill(kNowhere);
  EXPECT_EQ(MeanDistance_m(whole, target), 0.0);
  target[Joint::kHead] = whole[Joint::kHead] + Vector3d(0.0, 0.0, 0.3);
  target[Joint::kSpine] = whole[Joint::kSpine];
  EXPECT_NEAR(MeanDistance_m(whole, target), 0.15, 1e-12);
}

TEST(SidesExchanged, ExchangesStatesTooAndIsAnInvolution) {
  TrackedPosture seen;
  seen.posture = StandardStance();
  seen.state[Index(Joint::kHandLeft)] = TrackingState::kTracked;
  seen.confidence[Index(Joint::kHandLeft)] = 0.7;
  const TrackedPosture exchanged = SidesExchanged(seen);
  EXPECT_EQ(exchanged.posture[Joint::kHandRight], seen.posture[Joint::kHandLeft]);
  EXPECT_EQ(exchanged.state[Index(Joint::kHandRight)], TrackingState::kTracked);
  EXPECT_EQ(exchanged.confidence[Index(Joint::kHandRight)], 0.7);
  EXPECT_EQ(SidesExchanged(exchanged).posture.position_m, seen.posture.position_m);
}

TEST(AngleBetween, DependsOnTheDirectionsOnly) {
  EXPECT_NEAR(AngleBetween_rad(2.0 * Vector3d::UnitX(), Vector3d(3, 3, 0)), std::numbers::pi / 4,
              1e-12);
  EXPECT_NEAR(AngleBetween_rad(Vector3d::UnitX(), -Vector3d::UnitX()), std::numbers::pi, 1e-12);
}

TEST(RotationVector, IsTheShorterRotationForEitherSign) {
  const Vector3d axis = Vector3d(1, 2, -2) / 3.0;
  for (const double angle_rad : {0.0, 1e-14, 0.4, 3.0}) {
    Eigen::Quaterniond q(Eigen::AngleAxisd(angle_rad, axis));
    EXPECT_TRUE(ToRotationVector(q).isApprox(angle_rad * axis, 1e-9) || angle_rad < 1e-9);
    EXPECT_NEAR(ToRotationVector(q).norm(), angle_rad, 1e-12);
    q.coeffs() = -q.coeffs();
    EXPECT_NEAR(ToRotationVector(q).norm(), angle_rad, 1e-12);
  }
}

}  // namespace
}  // namespace ossa::recon
