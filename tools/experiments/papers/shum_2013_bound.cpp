#include "tools/experiments/papers/shum_2013_bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "recon/database/nearest.h"
#include "recon/database/posture_database.h"
#include "recon/normalise.h"

namespace ossa::tools {
namespace {

using recon::BoneLengths;
using recon::JointWeights;
using recon::kJointCount;
using recon::Posture;

constexpr size_t kBones = kJointCount - 1;
using Directions = std::array<Eigen::Vector3f, kBones>;

Directions ComputeDirections(const Posture& posture) {
  Directions out;
  for (size_t i = 1; i < kJointCount; ++i) {
    const auto parent = recon::ParentOf(i);
    const Eigen::Vector3d bone = posture.position_m[i] - posture.position_m[parent];
    out[i - 1] = bone.normalized().cast<float>();
  }
  return out;
}

/// Eq. 18 of one frame for equal bone lengths: the error of a bone is its length times the distance
/// of the unit directions.
double Error_cm(const Directions& a, const Directions& b, const BoneLengths& lengths_m) {
  double sum_m = 0.0;
  for (size_t i = 0; i < kBones; ++i) {
    sum_m += lengths_m[i + 1] * static_cast<double>((a[i] - b[i]).norm());
  }
  return 100.0 * sum_m / static_cast<double>(kBones);
}

bool IsComplete(const recon::SkeletonFrame& frame) {
  return !frame.bodies.empty() &&
         std::all_of(frame.bodies[0].joints.begin(), frame.bodies[0].joints.end(),
                     [](const auto& joint) { return joint && joint->position_m.allFinite(); });
}

}  // namespace

std::optional<DatabaseBound> ComputeBound(const recon::PostureDatabase& database,
                                          const recon::SkeletonSequence& truth,
                                          const std::vector<recon::Joint>& parts) {
  std::vector<Directions> nodes;
  for (int n = 0; n < database.size(); ++n) nodes.push_back(ComputeDirections(database.posture(n)));
  JointWeights all, given{};
  all.fill(1.0);
  given[0] = 1.0;
  for (const recon::Joint part : parts) given[part] = 1.0;
  DatabaseBound bound;
  double frames = 0.0, yaw_rad = std::numbers::pi;
  for (const auto& frame : truth.frames) {
    if (!IsComplete(frame)) continue;
    const Posture seen = recon::ToTrackedPosture(frame.bodies[0]).posture;
    const recon::Placement place = recon::EstimatePlacement(seen, all, yaw_rad);
    yaw_rad = place.yaw_rad;
    const Posture own = recon::Normalised(seen, place);
    const BoneLengths lengths_m = recon::MeasureBoneLengths(own);
    const Directions wanted = ComputeDirections(own);
    double nearest_cm = 1e9;
    for (const Directions& node : nodes) {
      nearest_cm = std::min(nearest_cm, Error_cm(wanted, node, lengths_m));
    }
    const auto query = recon::ToVector(recon::Retargeted(own, recon::StandardBoneLengths()));
    const int by_parts = recon::NearestPostures(database, query, given, 1).at(0).index;
    bound.nearest_cm += nearest_cm;
    bound.by_parts_cm += Error_cm(wanted, nodes[static_cast<size_t>(by_parts)], lengths_m);
    ++frames;
  }
  if (frames == 0.0) return std::nullopt;
  return DatabaseBound{bound.nearest_cm / frames, bound.by_parts_cm / frames};
}

Eigen::Vector3d ErrorByLimbs_cm(const recon::SkeletonSequence& truth,
                                const recon::SkeletonSequence& made) {
  Eigen::Vector3d sum_cm = Eigen::Vector3d::Zero(), count = Eigen::Vector3d::Zero();
  const size_t frames = std::min(truth.frames.size(), made.frames.size());
  for (size_t f = 0; f < frames; ++f) {
    if (!IsComplete(truth.frames[f]) || !IsComplete(made.frames[f])) continue;
    const auto& a = truth.frames[f].bodies[0].joints;
    const auto& b = made.frames[f].bodies[0].joints;
    for (size_t i = 1; i < kJointCount; ++i) {
      const auto parent = recon::ParentOf(i);
      const Eigen::Index limb = i < 4 ? 0 : i < 12 ? 1 : 2;
      sum_cm[limb] += 100.0 * ((a[i]->position_m - a[parent]->position_m) -
                               (b[i]->position_m - b[parent]->position_m))
                                  .norm();
      ++count[limb];
    }
  }
  return sum_cm.cwiseQuotient(count.cwiseMax(1.0));
}

}  // namespace ossa::tools
