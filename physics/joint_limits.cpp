#include "physics/joint_limits_internal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "depth/base/angles.h"
#include "recon/orientation.h"
#include "recon/smallest_turn.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;

// Constants: chosen by hand unless stated otherwise.

constexpr double kBound_nm = 200.0;    // approximate strength of ligaments
constexpr double kReturn_rad_s = 8.0;  // maximum return speed

struct Row {
  size_t left_bone, right_bone;
  Vector3d middle;  // direction of the left bone in the T-pose facing +z
  double reach_deg, twist_deg;
};

}  // namespace

/// After D. C. Boone & S. P. Azen, "Normal range of motion of joints in male subjects", J. Bone and
/// Joint Surgery 61-A, 1979 (elbow flexion 143 degrees, knee 143, hip 122 forward and 10 back,
/// shoulder 167 forward and 62 back, wrist 76 and 75, ankle 13 up and 56 down, hip rotation 47 in
/// and out), widened by 5-20 degrees, because people differ and sensor joints are not the
/// anatomical ones. ossa's authored clips are within these ranges except for some deep squats.
/// Departure: each range is a circular cone, while real cross-sections are not, and the axial range
/// does not depend on the swing.
const std::vector<JointRange>& JointRanges() {
  static const std::vector<JointRange> ranges = [] {
    const double bent = 70.0 * kDegree;  // the middle of a hinge's range
    const Vector3d elbow(std::cos(bent), 0.0, std::sin(bent));
    const Vector3d knee(0.0, -std::cos(bent), -std::sin(bent));
    const std::vector<Row> rows = {{3, 3, {0.0, 1.0, 0.0}, 60.0, 100.0},
                                   {5, 9, {0.65, -0.1, 0.75}, 115.0, 140.0},
                                   {6, 10, elbow, 80.0, 180.0},
                                   {7, 11, {1.0, 0.0, 0.0}, 85.0, 180.0},
                                   {13, 17, {0.2, -0.7, 0.7}, 95.0, 70.0},
                                   {14, 18, knee, 82.0, 60.0},
                                   {15, 19, {0.0, -0.6, 0.8}, 70.0, 70.0}};
    std::vector<JointRange> list;
    for (const Row& row : rows) {
      for (const bool left : {true, false}) {
        if (!left && row.left_bone == row.right_bone) continue;
        const size_t bone = left ? row.left_bone : row.right_bone;
        const Vector3d middle =
            left ? row.middle : Vector3d(-row.middle.x(), row.middle.y(), row.middle.z());
        const auto& parent = recon::RestOrientations()[BodyParentOf(bone)];
        list.push_back({bone, parent.conjugate() * middle.normalized(), row.reach_deg * kDegree,
                        row.twist_deg * kDegree});
      }
    }
    return list;
  }();
  return ranges;
}

Excess SwingExcess(const JointRange& range, const recon::JointOrientations& orientation) {
  const Vector3d along = orientation[range.bone] * Vector3d::UnitY();
  const Vector3d middle = orientation[BodyParentOf(range.bone)] * range.middle_of_parent;
  const Vector3d across = along.cross(middle);
  // Exactly opposite the middle any perpendicular axis is valid.
  const Vector3d axis =
      across.norm() < 1e-9 ? along.unitOrthogonal() : Vector3d(across.normalized());
  return {std::atan2(across.norm(), along.dot(middle)) - range.reach_rad, axis};
}

Excess TwistExcess(const JointRange& range, const recon::JointOrientations& orientation) {
  const size_t parent = BodyParentOf(range.bone);
  const auto& rest = recon::RestOrientations();
  const Eigen::Quaterniond at_rest =
      orientation[parent] * rest[parent].conjugate() * rest[range.bone];
  const Eigen::Quaterniond turned = at_rest.conjugate() * orientation[range.bone];
  // Swing-twist decomposition about the bone's y axis.
  double twist = 2.0 * std::atan2(turned.y(), turned.w());
  twist = std::remainder(twist, 2.0 * std::numbers::pi);
  const Vector3d along = orientation[range.bone] * Vector3d::UnitY();
  return {std::abs(twist) - range.twist_rad, twist > 0.0 ? Vector3d(-along) : along};
}

namespace {

/// Rotates the bone that ends in `bone` about its start, with everything attached to it.
void Turn(recon::Posture& posture, size_t bone, const Eigen::Quaterniond& by) {
  recon::JointArray<bool> moves{};
  const Vector3d pivot = posture.position_m[recon::ParentOf(bone)];
  for (size_t j = bone; j < recon::kJointCount; ++j) {
    moves[j] = j == bone || moves[recon::ParentOf(j)];
    if (moves[j]) posture.position_m[j] = pivot + by * (posture.position_m[j] - pivot);
  }
}

/// The axial rotation of an upper limb is determined by the bending direction of its elbow or knee.
/// Beyond the range, the lower limb is moved to the nearest direction allowed at the end of the
/// range, or stretched if none is near: its direction is projected onto the half-plane in which the
/// hinge may bend.
Vector3d NearestBend(const Eigen::Quaterniond& upper, const Excess& excess, double sign,
                     const Vector3d& lower) {
  const Vector3d along = upper * Vector3d::UnitY();
  const Vector3d bends_to =
      sign * (Eigen::AngleAxisd(excess.angle_rad, excess.axis) * (upper * Vector3d::UnitZ()));
  const double bent = lower.dot(bends_to);
  if (bent <= 0.0) return along;
  return (lower.dot(along) * along + bent * bends_to).normalized();
}

}  // namespace

recon::Posture WithinRanges(recon::Posture posture) {
  recon::JointOrientations orientation = recon::ComputeOrientations(posture);
  for (const JointRange& range : JointRanges()) {  // parents before children
    const Excess swing = SwingExcess(range, orientation);
    if (swing.angle_rad > 0.0) {
      Turn(posture, range.bone, Eigen::Quaterniond(Eigen::AngleAxisd(swing.angle_rad, swing.axis)));
      orientation = recon::ComputeOrientations(posture);
    }
    const bool arm = range.bone == 5 || range.bone == 9;
    if (!arm && range.bone != 13 && range.bone != 17) continue;  // no hinge determines it
    const Excess twist = TwistExcess(range, orientation);
    if (twist.angle_rad <= 0.0) continue;
    const Vector3d lower = posture.position_m[range.bone + 1] - posture.position_m[range.bone];
    const Vector3d to =
        NearestBend(orientation[range.bone], twist, arm ? 1.0 : -1.0, lower.normalized());
    Turn(posture, range.bone + 1, recon::SmallestTurn(lower, to));
    orientation = recon::ComputeOrientations(posture);
  }
  return posture;
}

JointLimits::JointLimits(OdeWorld& ode, const Character& character) : character_(character) {
  for (const JointRange& range : JointRanges()) {
    const dJointID motor = dJointCreateAMotor(ode.world, nullptr);
    dJointAttach(motor, character.body(range.bone), character.body(BodyParentOf(range.bone)));
    dJointSetAMotorMode(motor, dAMotorUser);
    dJointSetAMotorNumAxes(motor, 2);
    motor_.push_back(motor);
  }
}

JointLimits::~JointLimits() {
  for (const dJointID motor : motor_) dJointDestroy(motor);
}

void JointLimits::Update(double h_s) {
  constexpr std::array<int, 2> kBoundOf = {dParamFMax1, dParamFMax2};
  constexpr std::array<int, 2> kSpeedOf = {dParamVel1, dParamVel2};
  const recon::JointOrientations orientation = character_.orientation();
  for (size_t i = 0; i < motor_.size(); ++i) {
    const JointRange& range = JointRanges()[i];
    const std::array<Excess, 2> excess = {SwingExcess(range, orientation),
                                          TwistExcess(range, orientation)};
    for (size_t k = 0; k < 2; ++k) {
      const auto& [angle, axis] = excess[k];
      dJointSetAMotorParam(motor_[i], kBoundOf[k], angle > 0.0 ? kBound_nm : 0.0);
      if (angle <= 0.0) continue;
      dJointSetAMotorAxis(motor_[i], static_cast<int>(k), 0, axis.x(), axis.y(), axis.z());
      dJointSetAMotorParam(motor_[i], kSpeedOf[k], std::min(0.2 * angle / h_s, kReturn_rad_s));
    }
  }
}

}  // namespace ossa::physics
