#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"
#include "recon/posture.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// A person's hat and bag. Sizes in metres, for a person of average height.
struct Accessories {
  enum class Hat : uint8_t { kNone, kCap, kBrimmed, kWoolly };
  enum class Bag : uint8_t { kNone, kRucksack, kShoulderBag };
  Hat hat = Hat::kNone;
  Bag bag = Bag::kNone;
  Eigen::Vector3f bag_size_m = Eigen::Vector3f(0.3F, 0.42F, 0.15F);
  float brim_m = 0.07F;   // width of the brim
  float crown_m = 0.11F;  // height above the head's centre
  float on_left = 1.0F;   // 1: the shoulder bag hangs at the left, -1: at the right
};

/// One person in three has a hat, one in four a bag.
Accessories SampleAccessories(Random& random);

/// Meshes of the accessories in camera space on a posed body. A hat has the labels of the left and
/// right upper head; a bag is an object, label 32. `user` is the person's id.
std::vector<Prop> AccessoryProps(const Accessories& accessories, const recon::RigPose& pose,
                                 const recon::Posture& joints_in_cam, double height_m,
                                 const Eigen::Isometry3d& camera_from_world, uint8_t user);

}  // namespace ossa::tools
