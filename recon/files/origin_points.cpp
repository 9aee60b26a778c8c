#include "recon/files/origin_points_internal.h"

#include <algorithm>
#include <iterator>

namespace ossa::recon {

void OriginPoints::Add(size_t point, const Eigen::Vector3d& place_m) {
  if (place_m.isZero(0.0)) {
    at_origin_.insert(point);
    return;
  }
  elsewhere_.insert(point);
  nearest_m_ = std::min(nearest_m_, place_m.norm());
  farthest_m_ = std::max(farthest_m_, place_m.norm());
}

std::set<size_t> OriginPoints::FindRoots() const {
  // Metres, by hand: from hips or neck to the next joint, and to the farthest. Nobody can be so
  // near to a depth camera.
  constexpr double kNearest_m = 0.3, kFarthest_m = 1.5;
  if (nearest_m_ > kNearest_m || farthest_m_ > kFarthest_m) return {};
  std::set<size_t> roots;
  std::set_difference(at_origin_.begin(), at_origin_.end(), elsewhere_.begin(), elsewhere_.end(),
                      std::inserter(roots, roots.end()));
  return roots;
}

void RemoveUnseenAtOrigin(std::vector<std::vector<SeenPoint>>& rows) {
  OriginPoints origin;
  for (const auto& points : rows) {
    for (size_t p = 0; p < points.size(); ++p) {
      if (points[p]) origin.Add(p, *points[p]);
    }
  }
  const std::set<size_t> roots = origin.FindRoots();
  for (auto& points : rows) {
    for (size_t p = 0; p < points.size(); ++p) {
      if (points[p] && points[p]->isZero(0.0) && !roots.contains(p)) points[p].reset();
    }
  }
}

void RemoveUnseenAtOrigin(SkeletonSequence& sequence) {
  OriginPoints origin;
  const auto for_each_joint = [&](auto use) {
    for (SkeletonFrame& frame : sequence.frames) {
      for (BodyRecord& body : frame.bodies) {
        for (size_t j = 0; j < kJointCount; ++j) {
          if (body.joints[j]) use(j, body.joints[j]);
        }
      }
    }
  };
  for_each_joint([&](size_t j, const auto& joint) { origin.Add(j, joint->position_m); });
  const std::set<size_t> roots = origin.FindRoots();
  for_each_joint([&](size_t j, auto& joint) {
    if (joint->position_m.isZero(0.0) && !roots.contains(j)) joint.reset();
  });
}

}  // namespace ossa::recon
