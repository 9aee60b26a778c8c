#include "physics/anthropometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ossa::physics {
namespace {

using recon::Joint;
using recon::kJointCount;

/// One row of the table. `gyration`: radii of gyration as fractions of the bone's length, across
/// (mean of the sagittal and the transverse one) and along it; a `radius` of 0 is derived from mass
/// and density.
struct Row {
  double mass_fraction;
  double gyration_across, gyration_along;
  double radius_over_stature;
  double capsule_from, capsule_to;
};

// For trunk and hand the published radii refer to other lengths than our bones'; a uniform rod
// (0.29) is used instead. The axial radius of a trunk bone is that of its capsule.
constexpr Row kSpineRow = {0.1553, 0.29, 0.0, 0.062, 0.0, 1.0};
constexpr Row kChestRow = {0.1150, 0.29, 0.0, 0.062, 0.0, 0.75};
constexpr Row kHeadRow = {0.0681, 0.345, 0.0, 0.050, 0.55, 1.05};
constexpr Row kShoulderRow = {0.0200, 0.29, 0.0, 0.030, 0.2, 1.0};
constexpr Row kUpperArmRow = {0.0263, 0.269, 0.153, 0.0, 0.1, 0.95};
constexpr Row kForearmRow = {0.0150, 0.264, 0.108, 0.0, 0.1, 0.95};
constexpr Row kHandRow = {0.0059, 0.29, 0.0, 0.020, 0.2, 1.0};
constexpr Row kHipRow = {0.0591, 0.29, 0.0, 0.055, 0.0, 0.8};
constexpr Row kThighRow = {0.1447, 0.347, 0.156, 0.0, 0.15, 0.9};
constexpr Row kShankRow = {0.0457, 0.262, 0.098, 0.0, 0.1, 0.9};
constexpr Row kFootRow = {0.0133, 0.27, 0.132, 0.017, 0.0, 1.0};

const Row& RowOf(size_t joint) {
  switch (static_cast<Joint>(joint)) {
    case Joint::kHipCenter:
    case Joint::kSpine:
      return kSpineRow;
    case Joint::kShoulderCenter:
      return kChestRow;
    case Joint::kHead:
      return kHeadRow;
    case Joint::kShoulderLeft:
    case Joint::kShoulderRight:
      return kShoulderRow;
    case Joint::kElbowLeft:
    case Joint::kElbowRight:
      return kUpperArmRow;
    case Joint::kWristLeft:
    case Joint::kWristRight:
      return kForearmRow;
    case Joint::kHandLeft:
    case Joint::kHandRight:
      return kHandRow;
    case Joint::kHipLeft:
    case Joint::kHipRight:
      return kHipRow;
    case Joint::kKneeLeft:
    case Joint::kKneeRight:
      return kThighRow;
    case Joint::kAnkleLeft:
    case Joint::kAnkleRight:
      return kShankRow;
    case Joint::kFootLeft:
    case Joint::kFootRight:
      return kFootRow;
  }
  return kSpineRow;
}

constexpr double kTissueDensity_kg_m3 = 1080.0;  // limbs, Winter 2009 table 4.1: 1050-1160; density
// Anthropometry: the middle of the normal range (WHO)
constexpr double kBodyMassIndex_kg_m2 = 22.0;

Segment MakeSegment(const Row& row, double length_m, double stature_m, double mass_kg) {
  Segment segment;
  segment.length_m = length_m;
  segment.mass_kg = row.mass_fraction * mass_kg;
  segment.radius_m =
      row.radius_over_stature > 0.0
          ? row.radius_over_stature * stature_m
          : std::sqrt(segment.mass_kg / (kTissueDensity_kg_m3 * std::numbers::pi * length_m));
  // Sensor bones may be wrong: limits the radius of very short bones.
  segment.radius_m = std::min(segment.radius_m, 0.08 * stature_m);
  const double across_m = row.gyration_across * length_m;
  const double along_m = row.gyration_along > 0.0 ? row.gyration_along * length_m
                                                  : segment.radius_m / std::numbers::sqrt2;
  segment.transverse_inertia_kgm2 = segment.mass_kg * across_m * across_m;
  // A rigid body's moment of inertia about an axis is at most the sum of the other two.
  segment.axial_inertia_kgm2 =
      std::min(segment.mass_kg * along_m * along_m, 2.0 * segment.transverse_inertia_kgm2);
  segment.capsule_from = row.capsule_from;
  segment.capsule_to = row.capsule_to;
  return segment;
}

}  // namespace

double EstimateStature(const recon::BoneLengths& lengths) {
  const double legs = 0.5 * (lengths[Joint::kKneeLeft] + lengths[Joint::kKneeRight] +
                             lengths[Joint::kAnkleLeft] + lengths[Joint::kAnkleRight]);
  const double trunk =
      lengths[Joint::kSpine] + lengths[Joint::kShoulderCenter] + lengths[Joint::kHead];
  return std::clamp((legs + trunk) / (1.0 - 0.039 - 0.065), 0.4, 2.6);
}

Segments ComputeSegments(const recon::BoneLengths& lengths, double stature_m, double mass_kg) {
  if (stature_m <= 0.0) stature_m = EstimateStature(lengths);
  if (mass_kg <= 0.0) mass_kg = kBodyMassIndex_kg_m2 * stature_m * stature_m;
  double table_sum = 0.0;
  for (size_t i = 1; i < kJointCount; ++i) table_sum += RowOf(i).mass_fraction;
  Segments segments;
  for (size_t i = 1; i < kJointCount; ++i) {
    segments[i] = MakeSegment(RowOf(i), lengths[i], stature_m, mass_kg / table_sum);
  }
  return segments;
}

recon::JointArray<double> LumpedMasses(const Segments& segments) {
  recon::JointArray<double> lumped{};
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = recon::ParentOf(i);
    lumped[i] += 0.5 * segments[i].mass_kg;
    lumped[parent] += 0.5 * segments[i].mass_kg;
  }
  return lumped;
}

}  // namespace ossa::physics
