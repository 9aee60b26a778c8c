#include "recon/motion/up_axis_internal.h"

#include <algorithm>
#include <cmath>

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

Vector3d At(const std::vector<Vector3d>& position, int joint) {
  return position[static_cast<size_t>(joint)];
}

Vector3d UnitOrZero(const Vector3d& v) {
  const double length = v.norm();
  return length > 1e-9 ? Vector3d(v / length) : Vector3d::Zero();
}

constexpr double kStands = 0.7;  // cosine of the mean direction, by hand: allows bows and crouches

/// Statistics of the figure's stance over sampled frames.
struct Stance {
  Vector3d trunk = Vector3d::Zero();          // mean direction
  double least_z = 1.0;                       // of the trunk's direction, over all frames
  double lowest_y = 1e300, lowest_z = 1e300;  // over all joints, in leg lengths
};

Stance MeasureStance(const SourceMotion& motion, const SourceBones& bones) {
  Stance stance;
  const std::vector<SourceFrame> frames = SampleFrames(motion);
  const double leg = std::max(LegLength(frames.front().position, bones), 1e-9);
  for (const SourceFrame& frame : frames) {
    const Vector3d trunk = TrunkDirection(frame.position, bones);
    stance.trunk += trunk / static_cast<double>(frames.size());
    stance.least_z = std::min(stance.least_z, trunk.z());
    for (const SideBones& side : bones.side) {
      for (const int joint : {side.arm, side.fore_arm, side.up_leg, side.leg, side.foot}) {
        stance.lowest_y = std::min(stance.lowest_y, At(frame.position, joint).y() / leg);
        stance.lowest_z = std::min(stance.lowest_z, At(frame.position, joint).z() / leg);
      }
    }
  }
  return stance;
}

/// Whether feet stand at z = 0, and there is no floor at y = 0: joints are either far from it or
/// pass through it.
bool HasFloorAtZ0(const Stance& stance) {
  constexpr double kAnkleHigh = 0.3;  // ratio to the leg, by hand: standing ankles are at 0.1
  constexpr double kThrough = -0.06;  // leg lengths, by hand: 5 cm of an adult
  const bool z_is_floor = stance.lowest_z > kThrough && stance.lowest_z < kAnkleHigh;
  const bool y_is_floor = stance.lowest_y > kThrough && stance.lowest_y < kAnkleHigh;
  return z_is_floor && !y_is_floor;
}

}  // namespace

std::vector<SourceFrame> SampleFrames(const SourceMotion& motion, size_t most) {
  std::vector<SourceFrame> frames;
  const size_t step = (motion.frame_count + most - 1) / most;
  for (size_t f = 0; f < motion.frame_count; f += step) frames.push_back(motion.frame(f));
  return frames;
}

Vector3d TrunkDirection(const std::vector<Vector3d>& position, const SourceBones& bones) {
  const Vector3d hips = At(position, bones.side[0].up_leg) + At(position, bones.side[1].up_leg);
  const Vector3d shoulders = At(position, bones.side[0].arm) + At(position, bones.side[1].arm);
  return UnitOrZero(shoulders - hips);
}

double LegLength(const std::vector<Vector3d>& position, const SourceBones& bones) {
  double length = 0.0;
  for (const SideBones& side : bones.side) {
    length += 0.5 * (At(position, side.up_leg) - At(position, side.leg)).norm();
    length += 0.5 * (At(position, side.leg) - At(position, side.foot)).norm();
  }
  return length;
}

bool IsRestPose(const std::vector<Vector3d>& position, const SourceBones& bones) {
  const auto direction = [&](int from, int to) {
    return UnitOrZero(At(position, to) - At(position, from));
  };
  constexpr double kStretched = 0.5;  // cosine, by hand: 60 degrees, as in no rest pose
  const Vector3d trunk = TrunkDirection(position, bones);
  const Vector3d hips = direction(bones.side[1].up_leg, bones.side[0].up_leg);
  const Vector3d shoulders = direction(bones.side[1].arm, bones.side[0].arm);
  if (hips.dot(shoulders) < kStretched || std::abs(hips.dot(trunk)) > kStretched) return false;
  for (size_t s = 0; s < 2; ++s) {
    const SideBones& side = bones.side[s];
    if (trunk.dot(direction(side.up_leg, side.leg)) > -kStretched ||
        trunk.dot(direction(side.leg, side.foot)) > -kStretched) {
      return false;
    }
    const Vector3d arm = direction(side.arm, side.fore_arm);
    constexpr double kUpwards = 0.8, kAcross = -0.5;  // cosines, by hand
    if (arm.dot(trunk) > kUpwards || arm.dot(s == 0 ? hips : Vector3d(-hips)) < kAcross) {
      return false;
    }
  }
  return true;
}

bool IsUpright(const Vector3d& mean_trunk, const Vector3d& up) {
  return mean_trunk.dot(up) > kStands;
}

std::string DescribeUpDoubt(const std::string& source, const Vector3d& mean_trunk,
                            const Vector3d& up) {
  constexpr double kLeans = 0.5;  // cosine, by hand: 60 degrees, as nobody stands
  const double along = mean_trunk.dot(up);
  const bool is_clear = along < 0.0 || mean_trunk.norm() > kStands;
  if (!is_clear || along >= kLeans * mean_trunk.norm()) return "";
  return source +
         ": the body never stands along the axis taken as up: is it lying, or is another axis up "
         "in "
         "this file?";
}

Vector3d NearestAxis(const Vector3d& direction) {
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  return Vector3d::Unit(axis) * (direction[axis] < 0 ? -1.0 : 1.0);
}

UpAxis FindUpAxis(const SourceMotion& motion, const SourceBones& bones,
                  const std::optional<Vector3d>& rest_up) {
  const Stance stance = MeasureStance(motion, bones);
  if (IsUpright(stance.trunk, Vector3d::UnitY())) return {Vector3d::UnitY(), true, ""};
  const Vector3d up = rest_up.value_or(Vector3d::UnitY());
  const bool along_z = IsUpright(stance.trunk, Vector3d::UnitZ()) && stance.least_z > 0.0;
  if (along_z && (up == Vector3d::UnitZ() || HasFloorAtZ0(stance))) {
    return {Vector3d::UnitZ(), true, ""};
  }
  return {up, false, DescribeUpDoubt(motion.source, stance.trunk, up)};
}

}  // namespace ossa::recon
