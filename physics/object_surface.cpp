// Distance of a point from an object's surface.
#include <algorithm>

#include "physics/world_internal.h"

namespace ossa::physics {
namespace {

using Eigen::Vector3d;

/// Signed distance, negative inside. `point_m`: in the part's frame.
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

double DistanceToObject(const ObjectOptions& object, const Vector3d& point_m) {
  double nearest_m = DistanceToShape(object.shape, object.size_m, point_m);
  for (const ObjectPart& part : object.parts) {
    const Vector3d inside = part.orientation.normalized().conjugate() * (point_m - part.position_m);
    nearest_m = std::min(nearest_m, DistanceToShape(part.shape, part.size_m, inside));
  }
  return nearest_m;
}

double World::DistanceTo(int object, const Vector3d& point_m) const {
  const Thing& thing = impl_->things.at(object);
  return DistanceToObject(thing.info, PoseOf(thing.body).inverse() * point_m + thing.middle_m);
}

}  // namespace ossa::physics
