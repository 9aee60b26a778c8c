#include "tools/synth/accessories.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "depth/render/shapes.h"

namespace ossa::tools {
namespace {

// Constants: sizes of hats and bags on the average body, metres, chosen by hand.

using Eigen::Affine3f;
using Eigen::Vector3f;
using recon::Joint;

constexpr size_t kSpine1 = 13, kHead = 16;  // bone indices of the rig's format
constexpr double kAverageHeight_m = 1.66;

float Draw(Random& random, double low, double high) {
  return static_cast<float>(random.Uniform(low, high));
}

/// One half of a mesh, cut at x = 0; `side` 1: the left half.
depth::TriangleMesh Half(depth::TriangleMesh mesh, float side) {
  for (Vector3f& p : mesh.vertices_m) p.x() = side * std::max(0.0F, side * p.x());
  return mesh;
}

/// A hat in the head's axes, the head's centre at the origin.
depth::TriangleMesh MakeHat(const Accessories& accessories) {
  const float round_m = accessories.hat == Accessories::Hat::kWoolly ? 0.012F : 0.006F;
  depth::TriangleMesh hat = depth::MakeBall(1.0F, 20);
  for (Vector3f& p : hat.vertices_m) {
    p = Vector3f(p.x() * (0.085F + round_m), std::max(0.0F, p.y()) * accessories.crown_m + 0.035F,
                 p.z() * (0.105F + round_m));
  }
  if (accessories.hat == Accessories::Hat::kWoolly) return hat;
  depth::TriangleMesh brim = depth::MakeBall(1.0F, 20);
  for (Vector3f& p : brim.vertices_m) {
    p = Vector3f(p.x() * (0.09F + accessories.brim_m), p.y() * 0.006F + 0.045F,
                 p.z() * (0.11F + accessories.brim_m));
    if (accessories.hat == Accessories::Hat::kCap) {  // the peak is in front of the face only
      p.x() = std::clamp(p.x(), -0.075F, 0.075F);
      p.z() = std::max(0.0F, p.z());
    }
  }
  depth::Append(hat, brim);
  return hat;
}

/// A frame at a joint with a bone's axes: x to the person's left, y up, z to the front at rest.
Affine3f FrameAt(const recon::RigPose& pose, size_t bone, const Vector3f& at_m, float scale,
                 const Eigen::Isometry3d& camera_from_world) {
  const Eigen::Matrix3f turn =
      (camera_from_world.linear() * pose.world_from_rest[bone].toRotationMatrix()).cast<float>();
  return Eigen::Translation3f(at_m) * Affine3f(turn) * Eigen::Scaling(scale);
}

/// A strap between two points.
depth::TriangleMesh Strap(const Vector3f& from_m, const Vector3f& to_m) {
  constexpr float kHalfWidth_m = 0.018F;
  const Vector3f way = to_m - from_m;
  const auto turn = Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitY(), way);
  return depth::Moved(depth::MakeCapsule(kHalfWidth_m, way.norm(), 8),
                      Eigen::Translation3f((from_m + to_m) / 2) * turn * Affine3f::Identity());
}

/// A bag in the chest's axes, the origin midway between spine and base of the neck.
depth::TriangleMesh MakeBag(const Accessories& accessories) {
  const Vector3f& size = accessories.bag_size_m;
  depth::TriangleMesh bag = depth::MakeBox(size);
  if (accessories.bag == Accessories::Bag::kRucksack) {
    bag = depth::Moved(bag, Affine3f(Eigen::Translation3f(0, -0.06F, -0.13F - size.z() / 2)));
    for (const float side : {-1.0F, 1.0F}) {
      depth::Append(bag, Strap({side * 0.1F, 0.16F, 0.05F}, {side * 0.12F, -0.1F, 0.115F}));
    }
    return bag;
  }
  const Vector3f at(accessories.on_left * (0.17F + size.z() / 2), -0.38F, 0.02F);
  bag = depth::Moved(bag, Eigen::Translation3f(at) * Eigen::AngleAxisf(1.5708F, Vector3f::UnitY()) *
                              Affine3f::Identity());
  depth::Append(bag, Strap({-accessories.on_left * 0.09F, 0.16F, 0.06F},
                           {accessories.on_left * 0.16F, -0.25F, 0.12F}));
  return bag;
}

}  // namespace

Accessories SampleAccessories(Random& random) {
  Accessories accessories;
  if (random.Chance(1.0 / 3)) accessories.hat = static_cast<Accessories::Hat>(1 + random.Index(3));
  if (random.Chance(0.25)) accessories.bag = static_cast<Accessories::Bag>(1 + random.Index(2));
  accessories.brim_m = Draw(random, 0.04, 0.12);
  accessories.crown_m = Draw(random, 0.1, 0.16);
  const float wide_m = Draw(random, 0.22, 0.4), high_m = Draw(random, 0.2, 0.55);
  accessories.bag_size_m = {wide_m, high_m, Draw(random, 0.06, 0.25)};
  accessories.on_left = random.Chance(0.5) ? 1.0F : -1.0F;
  return accessories;
}

std::vector<Prop> AccessoryProps(const Accessories& accessories, const recon::RigPose& pose,
                                 const recon::Posture& joints_in_cam, double height_m,
                                 const Eigen::Isometry3d& camera_from_world, uint8_t user) {
  constexpr uint8_t kLeftUpperHead = 1, kRightUpperHead = 2;  // labels of parts.h
  std::vector<Prop> props;
  const auto scale = static_cast<float>(height_m / kAverageHeight_m);
  if (accessories.hat != Accessories::Hat::kNone) {
    const depth::TriangleMesh hat = MakeHat(accessories);
    const Affine3f frame =
        FrameAt(pose, kHead, joints_in_cam[Joint::kHead].cast<float>(), scale, camera_from_world);
    for (const auto& [side, part] : {std::pair{1.0F, kLeftUpperHead}, {-1.0F, kRightUpperHead}}) {
      props.push_back({depth::Moved(Half(hat, side), frame), true, Grip::kNone, part, user});
    }
  }
  if (accessories.bag != Accessories::Bag::kNone) {
    const Vector3f chest_m =
        (joints_in_cam[Joint::kSpine] + joints_in_cam[Joint::kShoulderCenter]).cast<float>() / 2;
    const Affine3f frame = FrameAt(pose, kSpine1, chest_m, scale, camera_from_world);
    props.push_back(
        {depth::Moved(MakeBag(accessories), frame), true, Grip::kNone, recon::kOtherPart, user});
  }
  return props;
}

}  // namespace ossa::tools
