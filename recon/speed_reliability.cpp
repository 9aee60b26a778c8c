#include <algorithm>
#include <vector>

#include "recon/reliability.h"

#include "depth/base/statistics.h"

namespace ossa::recon {

/// Motion of the whole body: the median over the joints per axis, robust to a few jumps.
Eigen::Vector3d SpeedTerm::BodyMoved(const Posture& posture, const JointWeights& seen) const {
  Eigen::Vector3d body = Eigen::Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> moved;
    for (size_t i = 0; i < kJointCount; ++i) {
      if (seen[i] == 0.0 || unbelieved_s_[i] < 0.0) continue;
      moved.push_back(posture.position_m[i][axis] - believed_.position_m[i][axis]);
    }
    if (moved.empty()) return Eigen::Vector3d::Zero();
    body[axis] = Median(std::move(moved));
  }
  return body;
}

JointWeights SpeedTerm::Step(const Posture& posture, const JointWeights& seen, double dt_s,
                             const ReliabilityOptions& options) {
  JointWeights speed;
  speed.fill(1.0);
  const Eigen::Vector3d body = BodyMoved(posture, seen);
  const Posture before = believed_;
  JointArray<bool> believed{};  // reliable now and before
  for (size_t i = 0; i < kJointCount; ++i) {
    if (seen[i] == 0.0) {
      unbelieved_s_[i] = -1.0;
      continue;
    }
    size_t above = ParentOf(i);
    while (above != 0 && !believed[above]) above = ParentOf(above);
    Eigen::Vector3d along = body;
    if (i != 0 && believed[above]) {
      along = posture.position_m[above] - before.position_m[above];
    }
    const bool first = unbelieved_s_[i] < 0.0;
    if (!first) {
      const double way_m = (posture.position_m[i] - before.position_m[i] - along).norm();
      const double over = way_m / (unbelieved_s_[i] + dt_s) - options.usual_speed;
      speed[i] = 1.0 - std::clamp(over / (options.no_speed - options.usual_speed), 0.0, 1.0);
    }
    if (speed[i] >= 0.5) {
      believed_.position_m[i] = posture.position_m[i];
      unbelieved_s_[i] = 0.0;
      believed[i] = !first;
    } else {
      believed_.position_m[i] += along;
      unbelieved_s_[i] += dt_s;
    }
  }
  return speed;
}

}  // namespace ossa::recon
