// Somebody on the floor: what is unseen of them is not below it.
#include <algorithm>
#include <array>
#include <cmath>

#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

using Eigen::Vector3d;

// Heights above the floor. Constants: by hand, with the people on the floor of rendered and real
// recordings in view.
constexpr double kLowest_m = -0.03;  // of a joint: the error of the floor's plane at 4 m
// Of the hips of who is on the floor. Lower ones mean that a table top was taken for the floor.
constexpr double kLowestHips_m = -0.15, kHighestHips_m = 0.5;
// Of a joint that is seen: lower ones mean the same.
constexpr double kLowestSeen_m = -0.08;
// Detections; in rendered first images the top of a box is taken for the floor now and then.
constexpr int kFewest = 12;

// A bone of this length from `parent_m` in the direction of `joint_m`, turned up until its end is
// not below the floor.
Vector3d TurnUp(const Vector3d& parent_m, const Vector3d& joint_m, double length_m,
                const Eigen::Vector4d& floor) {
  const Vector3d up = floor.head<3>();
  const Vector3d along = joint_m - parent_m;
  const double distance_m = along.norm();
  if (distance_m < 1e-6) return parent_m;
  const Vector3d end_m = parent_m + along * (length_m / distance_m);
  const double parent_height_m = up.dot(parent_m) + floor[3];
  if (up.dot(end_m) + floor[3] >= kLowest_m) return end_m;
  const double rise_m = std::clamp(kLowest_m - parent_height_m, -length_m, length_m);
  const Vector3d level = along - up.dot(along) * up;
  const double run_m = std::sqrt(std::max(0.0, length_m * length_m - rise_m * rise_m));
  const Vector3d ahead =
      level.norm() > 1e-3 ? Vector3d(level.normalized()) : Vector3d(up.unitOrthogonal());
  return parent_m + rise_m * up + run_m * ahead;
}

}  // namespace

void KeepAboveFloor(SkeletonWork& work) {
  if (!work.floor || work.detection == nullptr || work.detection->age < kFewest) return;
  const Eigen::Vector4d& floor = *work.floor;
  const recon::Posture before = work.posture;
  const auto height_m = [&](size_t j) {
    return floor.head<3>().dot(before.position_m[j]) + floor[3];
  };
  if (!(height_m(0) > kLowestHips_m && height_m(0) < kHighestHips_m)) return;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool is_seen = work.seen.state[j] == recon::TrackingState::kTracked;
    if (is_seen && height_m(j) < kLowestSeen_m) return;
  }
  std::array<bool, recon::kJointCount> moved{};
  if (height_m(0) < kLowest_m) {
    work.posture.position_m[0] += (kLowest_m - height_m(0)) * floor.head<3>();
    moved[0] = true;
  }
  for (size_t j = 1; j < recon::kJointCount; ++j) {
    const size_t parent = recon::ParentOf(j);
    if (!moved[parent] && !(height_m(j) < kLowest_m)) continue;
    const double length_m = (before.position_m[j] - before.position_m[parent]).norm();
    work.posture.position_m[j] =
        TurnUp(work.posture.position_m[parent], before.position_m[j], length_m, floor);
    moved[j] = true;
  }
  if (std::ranges::find(moved, true) != moved.end()) work.orientations.reset();
}

}  // namespace ossa::tracker
