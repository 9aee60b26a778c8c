#include "recon/motion/agreement_check_internal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "depth/base/angles.h"
#include "depth/base/error.h"

namespace ossa::recon {
namespace {

using Eigen::Vector3d;

/// Largest mean angle between a bone and the source's: limbs agree to rounding, trunks of other
/// rigs lean by up to 15 degrees, and a body on its side is off by 90 degrees.
constexpr double kMostApart_rad = 35.0 * kDegree;

Vector3d ComputeMiddle(const std::vector<Vector3d>& places, const std::array<int, 2>& joints) {
  return 0.5 * (places[static_cast<size_t>(joints[0])] + places[static_cast<size_t>(joints[1])]);
}

Vector3d ComputeMiddle(const Posture& posture, const std::array<Joint, 2>& joints) {
  return 0.5 * (posture[joints[0]] + posture[joints[1]]);
}

}  // namespace

AgreementCheck::AgreementCheck(const SourceBones& bones) {
  const SideBones &left = bones.side[0], &right = bones.side[1];
  pairs_ = {{"trunk",
             {left.up_leg, right.up_leg},
             {left.arm, right.arm},
             {Joint::kHipLeft, Joint::kHipRight},
             {Joint::kShoulderLeft, Joint::kShoulderRight}}};
  AddSide(left, true);
  AddSide(right, false);
}

void AgreementCheck::AddSide(const SideBones& side, bool left) {
  const auto own = [left](Joint joint) {
    return left ? joint : static_cast<Joint>(kMirroredJoint[Index(joint)]);
  };
  const auto add = [&](const char* name, int from, int to, Joint our_from, Joint our_to) {
    pairs_.push_back({std::string(left ? "left " : "right ") + name,
                      {from, from},
                      {to, to},
                      {own(our_from), own(our_from)},
                      {own(our_to), own(our_to)}});
  };
  add("upper arm", side.arm, side.fore_arm, Joint::kShoulderLeft, Joint::kElbowLeft);
  if (side.hand >= 0) {
    add("forearm", side.fore_arm, side.hand, Joint::kElbowLeft, Joint::kWristLeft);
  }
  add("thigh", side.up_leg, side.leg, Joint::kHipLeft, Joint::kKneeLeft);
  add("shin", side.leg, side.foot, Joint::kKneeLeft, Joint::kAnkleLeft);
}

void AgreementCheck::Add(const std::vector<Vector3d>& source, const Posture& ours) {
  for (Pair& pair : pairs_) {
    const Vector3d theirs = ComputeMiddle(source, pair.to) - ComputeMiddle(source, pair.from);
    const Vector3d made = ComputeMiddle(ours, pair.our_to) - ComputeMiddle(ours, pair.our_from);
    const double cosine = theirs.normalized().dot(made.normalized());
    pair.sum_rad += std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  ++frames_;
}

void AgreementCheck::Require(const std::string& source) const {
  const auto worst =
      std::max_element(pairs_.begin(), pairs_.end(),
                       [](const Pair& a, const Pair& b) { return a.sum_rad < b.sum_rad; });
  const double apart_rad = worst->sum_rad / static_cast<double>(frames_);
  if (frames_ == 0 || !(apart_rad > kMostApart_rad)) return;
  throw InputError(fmt::format(
      "{}: on the body the {} would lie {:.0f} degrees from where the file has it: expected joints "
      "of a person (name them, and a frame in a T-pose, in a mapping file)",
      source, worst->name, apart_rad / kDegree));
}

}  // namespace ossa::recon
