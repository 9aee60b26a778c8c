#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "depth/image/camera.h"
#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "recon/posture.h"

namespace ossa::tests {

/// How a capsule person stands. Lengths are shares of the height, as in anthropometric tables.
struct CapsulePose {
  double height_m = 1.75;
  Eigen::Vector3d feet_m{0, -1.0, 3.0};  // camera space, the floor point under the hips
  double yaw_rad = 0.0;                  // 0 faces the camera, growing turns to the person's left
  double left_lift_rad = 0.2;            // upper arm from hanging (0) to sideways (pi/2) to up (pi)
  double right_lift_rad = 0.2;
  double left_elbow_rad = 0.1;  // forearm bent forward out of the upper arm's line
  double right_elbow_rad = 0.1;
  double stride_rad = 0.0;  // left leg forward, right leg back
};

/// The 20 joints of the pose in camera space.
recon::Posture ComputeJoints(const CapsulePose& pose);

/// A sphere-swept segment with the part label of its surface; label 0 stands for furniture.
struct Capsule {
  Eigen::Vector3d a_m = Eigen::Vector3d::Zero(), b_m = Eigen::Vector3d::Zero();
  double radius_m = 0.1;
  uint8_t left_label = 0;   // label of points on the person's left side
  uint8_t right_label = 0;  // and on the right
};

/// An axis-aligned box of furniture.
struct Box {
  Eigen::Vector3d low_m = Eigen::Vector3d::Zero(), high_m = Eigen::Vector3d::Zero();
};

/// A plane n.x + d = 0 that reflects everywhere: floor, wall, ceiling.
struct Plane {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double offset_m = 0.0;
};

struct CapsuleScene {
  std::vector<CapsulePose> people;
  std::vector<Box> boxes;
  std::vector<Capsule> capsules;  // of animals and things
  std::vector<Plane> planes;
  double noise_m = 0.0;  // standard deviation at 1 m, growing with z squared
  uint64_t seed = 1;
};

struct CapsuleRender {
  depth::DepthFrame frame;
  depth::Image<uint8_t> part;    // label, 0 elsewhere
  depth::Image<uint8_t> person;  // 1 + index into people, 0 elsewhere
  std::vector<recon::Posture> joints;
};

/// Exact depth of the scene, ray by ray, without a renderer: every pixel's nearest analytic hit.
CapsuleRender Render(const CapsuleScene& scene, const depth::Camera& camera);

/// A floor 1 m below the sensor and a wall 4.5 m away.
std::vector<Plane> EmptyRoom();

}  // namespace ossa::tests
