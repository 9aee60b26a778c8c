// How far a point is from an object's surface.
#include <algorithm>

#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;

/// Below 0 inside. `point_m`: in the part's frame.
double DistanceToShape(Shape shape, const Vector3d& size_m, Vector3d point_m) {
  if (shape == Shape::kBox) {
    const Vector3d beyond = point_m.cwiseAbs() - 0.5 * size_m;
    return beyond.cwiseMax(0.0).norm() + std::min(beyond.maxCoeff(), 0.0);
  }
  if (shape == Shape::kCapsule) {
    const double half_m = 0.5 * size_m.y();
    point_m.y() -= std::clamp(point_m.y(), -half_m, half_m);
  }
  return point_m.norm() - 0.5 * size_m.x();
}

}  // namespace

double World::DistanceTo(int object, const Vector3d& point_m) const {
  const Thing& thing = impl_->things.at(object);
  const Vector3d point = PoseOf(thing.body).inverse() * point_m + thing.middle_m;
  double nearest_m = DistanceToShape(thing.info.shape, thing.info.size_m, point);
  for (const ObjectPart& part : thing.info.parts) {
    const Vector3d inside = part.orientation.normalized().conjugate() * (point - part.position_m);
    nearest_m = std::min(nearest_m, DistanceToShape(part.shape, part.size_m, inside));
  }
  return nearest_m;
}

}  // namespace ossa::physics
