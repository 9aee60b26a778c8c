#include "tools/stream/unity_humanoid.h"

#include <algorithm>

#include "recon/orientation.h"
#include "recon/smallest_turn.h"

namespace ossa::stream {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using recon::Joint;

// A half turn about the vertical and then Unity's left hand: x stays, z turns round.
Vector3d Unity(const Vector3d& level_m) { return {level_m.x(), level_m.y(), -level_m.z()}; }

// A rotation seen in a mirror across z = 0.
Quaterniond Unity(const Quaterniond& level) {
  return {level.w(), -level.x(), -level.y(), level.z()};
}

}  // namespace

void UnityRoom::Update(const tracker::BodyFrame& frame) {
  if (frame.floor) {
    constexpr int kMost = 300;  // by hand, frames: ten seconds, then a moved camera is followed
    floors_ = std::min(floors_ + 1, kMost);
    if (!floor_) floor_ = frame.floor;
    *floor_ += (*frame.floor - *floor_) / floors_;
    *floor_ /= floor_->head<3>().norm();
    level_from_camera_ =
        recon::SmallestTurn(Vector3d(floor_->head<3>()), Vector3d(Vector3d::UnitY()));
    height_m_ = floor_->w();
  }
  if (floor_) return;
  for (const tracker::Body& body : frame.bodies) {
    if (body.state != tracker::BodyState::kTracked) continue;
    for (const Joint foot : {Joint::kFootLeft, Joint::kFootRight}) {
      height_m_ = std::max(height_m_, -body.joints[foot].position_m.y());
    }
  }
}

Vector3d UnityRoom::Place(const Vector3d& camera_m) const {
  return Unity((level_from_camera_ * camera_m + height_m_ * Vector3d::UnitY()).eval());
}

Quaterniond UnityRoom::Turn(const Quaterniond& rotation) const {
  return Unity((level_from_camera_ * rotation).normalized());
}

Humanoid ComputePose(const tracker::Body& body, const UnityRoom& room) {
  // From the rest pose, which faces +z of camera space, to one that faces the sensor.
  const Quaterniond facing(0.0, 0.0, 1.0, 0.0);
  Humanoid pose;
  for (size_t b = 0; b < kHumanBoneCount; ++b) {
    const recon::HumanBoneInfo& bone = kHumanBones[b];
    const Quaterniond now = body.joints[bone.turner].orientation;
    const Quaterniond rest = facing * recon::RestOrientations()[bone.turner];
    pose[b].position_m = room.Place(body.joints[bone.place].position_m);
    pose[b].rotation = room.Turn(now * rest.conjugate());
  }
  return pose;
}

Humanoid ToLocal(const Humanoid& world) {
  Humanoid local = world;
  for (size_t b = 0; b < kHumanBoneCount; ++b) {
    if (kHumanBones[b].parent < 0) continue;
    const UnityTransform& parent = world[static_cast<size_t>(kHumanBones[b].parent)];
    const Quaterniond inverse = parent.rotation.conjugate();
    local[b].position_m = inverse * (world[b].position_m - parent.position_m);
    local[b].rotation = (inverse * world[b].rotation).normalized();
  }
  return local;
}

}  // namespace ossa::stream
