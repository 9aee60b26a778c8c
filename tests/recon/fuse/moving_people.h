#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <span>

#include "recon/skeleton_sequence.h"
#include "tests/recon/synthetic_motion.h"

namespace ossa::recon::test {

/// A person who gestures and walks along a non-periodic curve, in camera 0's space, at camera 0's
/// time. `phase_s` distinguishes people, who are two metres apart.
inline Posture WalkerAt(double t_s, double phase_s = 0.0) {
  Posture posture = InFrontOfCamera(Motion(t_s + phase_s), 1.0, 3.0);
  const Eigen::Vector3d step_m(0.5 * std::sin(0.9 * t_s + phase_s) + (phase_s > 0.0 ? 2.0 : 0.0),
                               0.0, 0.4 * std::sin(0.53 * t_s * t_s / 10.0 + 0.7 * t_s));
  for (auto& position_m : posture.position_m) position_m += step_m;
  return posture;
}

/// A camera that sees such people.
struct MadeUpCamera {
  Eigen::Isometry3d from_camera_0 = Eigen::Isometry3d::Identity();
  double clock_offset_s = 0.0;  // added to its times: camera 0's
  double noise_m = 0.0;         // standard deviation along each axis
  uint64_t seed = 1;
};

/// The person, each joint tracked with confidence 1, in the camera's space.
inline BodyRecord SeenBody(int id, Posture in_camera_0, const MadeUpCamera& camera,
                           std::mt19937_64& rng) {
  if (camera.noise_m > 0.0) AddNoise(in_camera_0, camera.noise_m, rng);
  BodyRecord body;
  body.id = id;
  for (size_t j = 0; j < kJointCount; ++j) {
    JointRecord& joint = body.joints[j].emplace();
    joint.position_m = camera.from_camera_0 * in_camera_0.position_m[j];
    joint.state = TrackingState::kTracked;
    joint.confidence = 1.0;
  }
  return body;
}

/// What the camera records in 30 frames a second of walkers with these phases, ids 1, 2, ...
inline SkeletonSequence Record(const MadeUpCamera& camera, std::span<const double> phases_s,
                               int frames, const char* name = "camera") {
  std::mt19937_64 rng(camera.seed);
  SkeletonSequence sequence{name, {}};
  for (int f = 0; f < frames; ++f) {
    SkeletonFrame frame;
    frame.frame = f;
    frame.time_s = f / 30.0;
    const double t_s = frame.time_s + camera.clock_offset_s;
    for (size_t k = 0; k < phases_s.size(); ++k) {
      frame.bodies.push_back(
          SeenBody(static_cast<int>(k) + 1, WalkerAt(t_s, phases_s[k]), camera, rng));
    }
    sequence.frames.push_back(frame);
  }
  return sequence;
}

/// A camera 70 degrees to the side of camera 0, three metres before the walkers, tilted.
inline Eigen::Isometry3d FromTheSide() {
  constexpr double kTurn_rad = 1.22, kTilt_rad = 0.15;
  Eigen::Isometry3d from_camera_0 = Eigen::Isometry3d::Identity();
  from_camera_0.linear() = (Eigen::AngleAxisd(kTilt_rad, Eigen::Vector3d::UnitX()) *
                            Eigen::AngleAxisd(kTurn_rad, Eigen::Vector3d::UnitY()))
                               .toRotationMatrix();
  from_camera_0.translation() = Eigen::Vector3d(-2.7, 0.3, 1.9);
  return from_camera_0;
}

}  // namespace ossa::recon::test
