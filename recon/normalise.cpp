#include "recon/normalise.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace ossa::recon {
namespace {

// Joints of the standard body at rest (recon/body/standard_body.h), metres; left side and midline.
constexpr double kMiddle_m[4][3] = {
    {0.0, 0.9136, -0.0062}, {0.0, 1.0948, -0.0084}, {0.0, 1.4137, 0.0051}, {0.0, 1.5886, 0.0409}};
constexpr double kLeftArm_m[4][3] = {{0.1700, 1.3199, 0.0193},
                                     {0.3314, 1.1393, 0.0201},
                                     {0.4533, 1.0151, 0.1833},
                                     {0.4754, 0.9894, 0.2216}};
constexpr double kLeftLeg_m[4][3] = {{0.1014, 0.8657, 0.0049},
                                     {0.1425, 0.4747, 0.0374},
                                     {0.1806, 0.0692, 0.0227},
                                     {0.1945, 0.0245, 0.1535}};

// Heights of the smallest and tallest supported people, relative to the standard body's 1.66 m.
constexpr double kSmallestScale = 0.9 / 1.66;
constexpr double kLargestScale = 2.2 / 1.66;

Posture MakeStance() {
  Posture stance;
  const auto put = [&](size_t first, const double(&table)[4][3], double side) {
    for (size_t i = 0; i < 4; ++i) {
      stance.position_m[first + i] = {side * table[i][0], table[i][1], table[i][2]};
    }
  };
  put(0, kMiddle_m, 1.0);
  put(4, kLeftArm_m, 1.0);
  put(8, kLeftArm_m, -1.0);
  put(12, kLeftLeg_m, 1.0);
  put(16, kLeftLeg_m, -1.0);
  return stance;
}

Eigen::Vector3d RotatedAboutY(const Eigen::Vector3d& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x() + s * p.z(), p.y(), -s * p.x() + c * p.z()};
}

}  // namespace

const Posture& StandardStance() {
  static const Posture stance = MakeStance();
  return stance;
}

const BoneLengths& StandardBoneLengths() {
  static const BoneLengths lengths = MeasureBoneLengths(StandardStance());
  return lengths;
}

Placement EstimatePlacement(const Posture& in_camera, const JointWeights& weights,
                            double previous_yaw_rad) {
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  const auto add = [&](Joint l, Joint r) {
    const Eigen::Vector3d across = in_camera[l] - in_camera[r];
    if (across.allFinite()) left += std::min(weights[l], weights[r]) * across;
  };
  add(Joint::kHipLeft, Joint::kHipRight);
  add(Joint::kShoulderLeft, Joint::kShoulderRight);
  Placement placement{in_camera[Joint::kHipCenter], previous_yaw_rad};
  // Ry(yaw) takes +x to (cos yaw, 0, -sin yaw). Below 2 cm the line is noise.
  if (Eigen::Vector2d(left.x(), left.z()).norm() > 0.02)
    placement.yaw_rad = std::atan2(-left.z(), left.x());
  return placement;
}

Posture Normalised(const Posture& in_camera, const Placement& camera_from_normalised) {
  Posture out;
  for (size_t i = 0; i < kJointCount; ++i) {
    out.position_m[i] = RotatedAboutY(in_camera.position_m[i] - camera_from_normalised.root_m,
                                      -camera_from_normalised.yaw_rad);
  }
  return out;
}

Posture Placed(const Posture& normalised, const Placement& camera_from_normalised) {
  Posture out;
  for (size_t i = 0; i < kJointCount; ++i) {
    out.position_m[i] = camera_from_normalised.root_m +
                        RotatedAboutY(normalised.position_m[i], camera_from_normalised.yaw_rad);
  }
  return out;
}

Posture Mirrored(const Posture& normalised) {
  Posture out;
  for (size_t i = 0; i < kJointCount; ++i) {
    out.position_m[i] = normalised.position_m[kMirroredJoint[i]];
    out.position_m[i].x() *= -1.0;
  }
  return out;
}

Posture Scaled(const Posture& posture, double factor) {
  Posture out = posture;
  for (auto& p : out.position_m) p *= factor;
  return out;
}

Posture Retargeted(const Posture& posture, const BoneLengths& lengths_m) {
  const Posture& stance = StandardStance();
  Posture out;
  out.position_m[0] = posture.position_m[0];
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = ParentOf(i);
    Eigen::Vector3d direction = posture.position_m[i] - posture.position_m[parent];  // eq. 3
    if (!direction.allFinite() || direction.norm() < 1e-6) {
      direction = stance.position_m[i] - stance.position_m[parent];
    }
    out.position_m[i] = out.position_m[parent] + direction.normalized() * lengths_m[i];  // eq. 4
  }
  return out;
}

BoneLengths ScaledBoneLengths(double scale) {
  BoneLengths lengths = StandardBoneLengths();
  for (double& length : lengths) length *= scale;
  return lengths;
}

double EstimateBodyScale(const BoneLengths& lengths_m, const JointWeights& weights) {
  std::vector<std::pair<double, double>> ratios;  // ratio, weight
  double total = 0.0;
  for (size_t i = 1; i < kJointCount; ++i) {
    const double weight = std::min(weights[i], weights[ParentOf(i)]);
    // Longer bones are weighted more: errors of the ends matter less.
    const double trust = weight * StandardBoneLengths()[i];
    if (!(trust > 0.0) || !std::isfinite(lengths_m[i]) || lengths_m[i] < 1e-3) continue;
    ratios.emplace_back(lengths_m[i] / StandardBoneLengths()[i], trust);
    total += trust;
  }
  std::sort(ratios.begin(), ratios.end());
  double below = 0.0;
  for (const auto& [ratio, trust] : ratios) {
    below += trust;
    if (below >= 0.5 * total) return std::clamp(ratio, kSmallestScale, kLargestScale);
  }
  return 1.0;
}

}  // namespace ossa::recon
