#include "tools/experiments/simulation/recording_simulator_internal.h"

namespace ossa::tools {

// Constants: chosen by hand unless stated otherwise.

Eigen::Vector3d SimulatedSdk::Noise(double deviation_m) {
  const double x = random_.Normal(0, deviation_m);
  const double y = random_.Normal(0, deviation_m);
  return {x, y, random_.Normal(0, deviation_m)};
}

Eigen::Vector3d SimulatedSdk::Hidden(const SequenceFrame& frame, const Eigen::Vector3d& true_m,
                                     const Eigen::Vector3d& hips_m, JointMemory& memory) {
  constexpr double kGrabbedShare = 0.5;  // share of the occluded joints that jump to the occluder
  constexpr double kWander_m = 0.02;     // a frame
  // Decay towards the old position: 8 cm per axis in the long run; factor per frame
  constexpr double kHome = 0.97;
  constexpr double kFlesh_m = 0.05;     // depth of a joint behind the visible surface
  constexpr double kSameDepth_m = 0.1;  // a nearer surface is the joint's own
  if (!memory.hidden) {
    memory.hidden = true;
    memory.grabbed = random_.Chance(kGrabbedShare);
    memory.wander_m.setZero();
  }
  memory.wander_m = kHome * memory.wander_m + Noise(kWander_m);
  if (memory.grabbed && true_m.z() > 0) {
    const depth::DepthView view = frame.depth.view();
    const Eigen::Vector2d pixel = depth::Project(frame.depth.camera, true_m);
    const int u = static_cast<int>(std::lround(pixel.x()));
    const int v = static_cast<int>(std::lround(pixel.y()));
    const int depth_mm = view.Contains(u, v) ? view.at(u, v) : 0;
    if (depth_mm > 0 && 1e-3 * depth_mm < true_m.z() - kSameDepth_m) {
      Eigen::Vector3d surface_m = depth::BackProject(frame.depth.camera, u, v, depth_mm);
      surface_m.z() += kFlesh_m;
      return surface_m + Noise(kWander_m);
    }
  }
  return memory.seen_once ? Eigen::Vector3d(hips_m + memory.from_hips_m + memory.wander_m)
                          : Eigen::Vector3d(true_m + memory.wander_m);
}

recon::SkeletonFrame SimulatedSdk::Observe(const SequenceFrame& frame) {
  constexpr double kJitter_m = 0.006;
  constexpr double kDrift_m = 0.015;  // standard deviation of the slow part
  constexpr double kKeep = 0.95;      // of the drift from one frame to the next; factor a frame
  recon::SkeletonFrame observed = frame.truth;
  auto& joints = observed.bodies.at(0).joints;
  const Eigen::Vector3d hips_m = joints[0]->position_m;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    recon::JointRecord& joint = *joints[j];
    JointMemory& memory = memory_[j];
    const bool seen = joint.visible.value_or(true);
    joint.visible.reset();
    memory.drift_m = kKeep * memory.drift_m + Noise(kDrift_m * std::sqrt(1 - kKeep * kKeep));
    if (seen) {
      memory.hidden = false;
      memory.seen_once = true;
      memory.from_hips_m = joint.position_m - hips_m;
      joint.position_m += memory.drift_m + Noise(kJitter_m);
      joint.state = recon::TrackingState::kTracked;
      joint.confidence = 0.9;
    } else {
      joint.position_m = Hidden(frame, joint.position_m, hips_m, memory);
      joint.state =
          memory.grabbed ? recon::TrackingState::kTracked : recon::TrackingState::kInferred;
      joint.confidence = memory.grabbed ? 0.6 : 0.3;
    }
  }
  return observed;
}

}  // namespace ossa::tools
