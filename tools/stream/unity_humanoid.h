#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "recon/motion/humanoid.h"
#include "tools/tracker/tracker.h"

namespace ossa::stream {

using recon::HumanBone;
using recon::kHumanBoneCount;
using recon::kHumanBones;

/// A place and a rotation in Unity's axes: left-handed, x right, y up, z forward; metres.
struct UnityTransform {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
using Humanoid = std::array<UnityTransform, kHumanBoneCount>;

/// From camera space to a room in Unity's axes: the floor is y = 0 below the sensor, up is off the
/// floor, and who faces the sensor faces +z. Remembers the floor.
class UnityRoom {
 public:
  /// Takes the frame's floor into account, if there is one. Until one is seen the camera is taken
  /// to be level, and the lowest foot to stand on the floor.
  void Update(const tracker::BodyFrame& frame);

  Eigen::Vector3d Place(const Eigen::Vector3d& camera_m) const;
  /// A rotation of camera space.
  Eigen::Quaterniond Turn(const Eigen::Quaterniond& rotation) const;

 private:
  std::optional<Eigen::Vector4d> floor_;  // mean of those seen
  int floors_ = 0;
  double height_m_ = 0.0;  // of the sensor, while no floor is seen
  Eigen::Quaterniond level_from_camera_ = Eigen::Quaterniond::Identity();
};

/// Positions of a body's bones, and their rotations from a T-pose that faces +z, in the room.
Humanoid ComputePose(const tracker::Body& body, const UnityRoom& room);
/// The same with each bone in its parent's space, as in a hierarchy of transforms.
Humanoid ToLocal(const Humanoid& world);

}  // namespace ossa::stream
