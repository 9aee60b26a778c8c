#include "recon/orientation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "recon/smallest_turn.h"

namespace ossa::recon {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// Constants: bounds against division by 0, by hand.

constexpr double kTinyLength_m = 1e-6;

/// Frame with y axis `y` and its x axis as close to `x_hint` as possible.
Quaterniond FrameFrom(const Vector3d& y, const Vector3d& x_hint) {
  const Vector3d axis = y.normalized();
  Vector3d x = x_hint - axis * axis.dot(x_hint);
  if (!(x.norm() > 1e-9)) x = axis.unitOrthogonal();
  x.normalize();
  Matrix3d frame;
  frame << x, axis, x.cross(axis);
  return Quaterniond(frame).normalized();
}

JointOrientations MakeRest() {
  const Vector3d forward = Vector3d::UnitZ();
  const auto facing_forward = [&](const Vector3d& y) { return FrameFrom(y, y.cross(forward)); };
  const Quaterniond left = facing_forward(Vector3d::UnitX());
  const Quaterniond right = facing_forward(-Vector3d::UnitX());
  const Quaterniond down = facing_forward(-Vector3d::UnitY());
  const Quaterniond foot = FrameFrom(forward, forward.cross(Vector3d::UnitY()));
  JointOrientations rest;
  rest.fill(Quaterniond::Identity());
  for (const size_t bone : {4U, 5U, 6U, 7U, 12U}) rest[bone] = left;
  for (const size_t bone : {8U, 9U, 10U, 11U, 16U}) rest[bone] = right;
  for (const size_t bone : {13U, 14U, 17U, 18U}) rest[bone] = down;
  for (const size_t bone : {15U, 19U}) rest[bone] = foot;
  return rest;
}

/// The bone that determines an upper limb's hinge axis, and the sign of that axis along the bone's
/// x.
struct Hinge {
  Joint upper, lower;
  double sign;
};
constexpr std::array<Hinge, 4> kHinges = {{{Joint::kElbowLeft, Joint::kWristLeft, 1.0},
                                           {Joint::kElbowRight, Joint::kWristRight, 1.0},
                                           {Joint::kKneeLeft, Joint::kAnkleLeft, -1.0},
                                           {Joint::kKneeRight, Joint::kAnkleRight, -1.0}}};

class Solver {
 public:
  explicit Solver(const Posture& posture) : posture_(posture) { result_ = RestOrientations(); }

  JointOrientations Run() {
    SolvePlayer();
    for (size_t bone = 1; bone < kJointCount; ++bone) SolveBone(bone);
    return result_;
  }

 private:
  Vector3d Bone(size_t bone) const {
    const auto parent = ParentOf(bone);
    return posture_.position_m[bone] - posture_.position_m[parent];
  }
  Vector3d Across(Joint right, Joint left) const { return posture_[left] - posture_[right]; }
  static bool Usable(const Vector3d& v) { return v.allFinite() && v.norm() > kTinyLength_m; }

  void SolvePlayer() {
    const Vector3d up = Bone(Index(Joint::kSpine));
    const Vector3d left = Across(Joint::kHipRight, Joint::kHipLeft);
    if (Usable(up) && Usable(left)) {
      // The line of the hips is more reliable: it keeps its direction and `up` is adjusted.
      const Quaterniond by_up = FrameFrom(up, left);
      const Vector3d x = left.normalized();
      Vector3d y = up - x * x.dot(up);
      if (y.norm() > kTinyLength_m) {
        y.normalize();
        Matrix3d frame;
        frame << x, y, x.cross(y);
        result_[0] = Quaterniond(frame).normalized();
      } else {
        result_[0] = by_up;
      }
    } else if (Usable(up)) {
      result_[0] = FrameFrom(up, Vector3d::UnitX());
    }
  }

  void SolveBone(size_t bone) {
    const auto parent = ParentOf(bone);
    const JointOrientations& rest = RestOrientations();
    const Quaterniond carried = result_[parent] * rest[parent].conjugate() * rest[bone];
    const Vector3d y = Bone(bone);
    if (!Usable(y)) {
      result_[bone] = carried.normalized();
      return;
    }
    const Vector3d direction = y.normalized();
    const Quaterniond swing = SmallestTurn(carried * Vector3d::UnitY(), direction);
    const Vector3d x_carried = swing * (carried * Vector3d::UnitX());
    result_[bone] = FrameFrom(direction, XHint(bone, direction, x_carried));
  }

  Vector3d XHint(size_t bone, const Vector3d& direction, const Vector3d& x_carried) const {
    const auto joint = static_cast<Joint>(bone);
    if (joint == Joint::kSpine) {
      const Vector3d hips = Across(Joint::kHipRight, Joint::kHipLeft);
      return Usable(hips) ? hips : x_carried;
    }
    if (joint == Joint::kShoulderCenter) {
      const Vector3d shoulders = Across(Joint::kShoulderRight, Joint::kShoulderLeft);
      return Usable(shoulders) ? shoulders : x_carried;
    }
    for (const Hinge& hinge : kHinges) {
      if (hinge.upper != joint) continue;
      const Vector3d lower = Bone(static_cast<size_t>(hinge.lower));
      if (!Usable(lower)) return x_carried;
      const Vector3d axis = hinge.sign * direction.cross(lower.normalized());
      const double sine = axis.norm();
      constexpr double kSine10 = 0.1736, kSine30 = 0.5;  // sines of 10 and 30 degrees
      const double t = std::clamp((sine - kSine10) / (kSine30 - kSine10), 0.0, 1.0);
      const double weight = t * t * (3.0 - 2.0 * t);
      if (weight <= 0.0) return x_carried;
      return (1.0 - weight) * x_carried + weight * axis.normalized();
    }
    return x_carried;
  }

  const Posture& posture_;
  JointOrientations result_;
};

/// The rotation about `joint`'s bone from our axes to the SDK 2's, as KERAAL's recordings of the
/// SDK 2 have it (RealKinectV2 of recon_skeleton_files_test).
Eigen::Quaterniond Sdk2Turn(Joint joint) {
  const auto about_y = [](double degrees) {
    return Eigen::Quaterniond(
        Eigen::AngleAxisd(degrees * std::numbers::pi / 180.0, Vector3d::UnitY()));
  };
  switch (joint) {
    case Joint::kElbowLeft:
    case Joint::kKneeLeft:
    case Joint::kAnkleLeft:
      return about_y(-90.0);
    case Joint::kElbowRight:
    case Joint::kKneeRight:
    case Joint::kAnkleRight:
      return about_y(90.0);
    default:
      return Eigen::Quaterniond::Identity();
  }
}

}  // namespace

const JointOrientations& RestOrientations() {
  static const JointOrientations rest = MakeRest();
  return rest;
}

JointOrientations ComputeOrientations(const Posture& posture) { return Solver(posture).Run(); }

JointOrientations AlignToBones(const JointOrientations& orientations, const Posture& posture) {
  JointOrientations out = orientations;
  out[0] = ComputeOrientations(posture)[0];
  for (size_t i = 1; i < kJointCount; ++i) {
    const Vector3d bone = posture.position_m[i] - posture.position_m[ParentOf(i)];
    if (!(bone.allFinite() && bone.norm() > kTinyLength_m)) continue;
    out[i] = (SmallestTurn(out[i] * Vector3d::UnitY(), bone) * out[i]).normalized();
  }
  return out;
}

JointOrientations ToHierarchical(const JointOrientations& absolute) {
  JointOrientations relative = absolute;
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    relative[i] = (absolute[parent].conjugate() * absolute[i]).normalized();
  }
  return relative;
}

JointOrientations ToAbsolute(const JointOrientations& hierarchical) {
  JointOrientations absolute = hierarchical;
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    absolute[i] = (absolute[parent] * hierarchical[i]).normalized();
  }
  return absolute;
}

Eigen::Quaterniond OrientationFromSdk2(Joint joint, const Eigen::Quaterniond& sdk2) {
  return sdk2 * Sdk2Turn(joint).conjugate();
}

Eigen::Quaterniond OrientationToSdk2(Joint joint, const Eigen::Quaterniond& orientation) {
  return orientation * Sdk2Turn(joint);
}

}  // namespace ossa::recon
