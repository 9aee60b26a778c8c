// From the ceiling: legs that nobody saw stand on the floor below the hips.
#include "recon/body/standard_body.h"
#include "recon/t_pose.h"
#include "tests/tools/tracker/tracked_scenes.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

using recon::Index;
using recon::Joint;
using recon::TrackingState;

constexpr double kCamera_m = 2.5;  // over the floor
constexpr double kAnkle_m = 0.08;  // over the floor, of who stands
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitY();

// Somebody aside of the camera who faces +z, the hips lower than straight legs would have them.
class Standing : public testing::Test {
 protected:
  Standing() {
    options_.from_above = true;
    options_.reconstructor.method = "none";
    lengths_m_ = AverageBones();
    posture_ = recon::BuildTPose(lengths_m_);
    const double legs_m = lengths_m_[Joint::kKneeLeft] + lengths_m_[Joint::kAnkleLeft];
    const double hips_m = kAnkle_m + 0.9 * legs_m;
    for (auto& joint_m : posture_.position_m) {
      joint_m += Eigen::Vector3d(0.7, hips_m - kCamera_m, 0.4);
    }
    before_ = posture_;
  }
  static recon::BoneLengths AverageBones() {
    return recon::MeasureBoneLengths(recon::StandardPosture(recon::RigPose{}));
  }
  recon::Posture Stand() {
    SkeletonWork work{options_, frame_, floor_, nullptr, person_, body_};
    work.posture = posture_;
    StandOnFloor(work);
    return work.posture;
  }

  SkeletonOptions options_;
  depth::DepthFrame frame_;
  std::optional<Eigen::Vector4d> floor_ = Eigen::Vector4d(0.0, 1.0, 0.0, kCamera_m);
  Person person_;
  Body body_;
  recon::BoneLengths lengths_m_{};
  recon::Posture posture_, before_;
};

TEST_F(Standing, AnklesAreOnTheFloorBelowTheHips) {
  const recon::Posture made = Stand();
  for (const auto& [hip, ankle] : {std::pair{Joint::kHipLeft, Joint::kAnkleLeft},
                                   std::pair{Joint::kHipRight, Joint::kAnkleRight}}) {
    EXPECT_NEAR(made[ankle].y() + kCamera_m, kAnkle_m, 1e-9);
    EXPECT_NEAR(made[ankle].x(), made[hip].x(), 1e-9);
    EXPECT_NEAR(made[ankle].z(), made[hip].z(), 1e-9);
  }
}

TEST_F(Standing, KneesAndFeetPointWhereTheBodyFaces) {
  const recon::Posture made = Stand();
  for (const auto& [knee, foot] : {std::pair{Joint::kKneeLeft, Joint::kFootLeft},
                                   std::pair{Joint::kKneeRight, Joint::kFootRight}}) {
    for (const Joint joint : {knee, foot}) {
      const Eigen::Vector3d hip_m = made[recon::Joint(Index(knee) - 1)];
      EXPECT_GT(made[joint].z(), hip_m.z() + 0.05);
      EXPECT_NEAR(made[joint].x(), hip_m.x(), 1e-9) << "nor aside";
    }
  }
}

TEST_F(Standing, BonesKeepTheirLengths) {
  const recon::BoneLengths made_m = recon::MeasureBoneLengths(Stand());
  for (size_t j = Index(Joint::kHipLeft); j < recon::kJointCount; ++j) {
    EXPECT_NEAR(made_m[j], lengths_m_[j], 1e-9) << j;
  }
}

TEST_F(Standing, VisibleLegStaysInPlace) {
  body_.raw.state[Index(Joint::kKneeLeft)] = TrackingState::kTracked;
  const recon::Posture made = Stand();
  EXPECT_EQ(made[Joint::kAnkleLeft], before_[Joint::kAnkleLeft]);
  EXPECT_NE(made[Joint::kAnkleRight], before_[Joint::kAnkleRight]);
}

TEST_F(Standing, OtherPosturesStayUnchanged) {
  options_.from_above = false;
  EXPECT_EQ(Stand().position_m, before_.position_m) << "of a level camera";
  options_.from_above = true;
  floor_.reset();
  EXPECT_EQ(Stand().position_m, before_.position_m) << "without a floor";
}

}  // namespace
}  // namespace ossa::tracker
