#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"
#include "recon/posture.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// What a person has on that is no cloth over the skin: a hat, a bag. Sizes in metres, of a person
/// of average height.
struct Accessories {
  enum class Hat : uint8_t { kNone, kCap, kBrimmed, kWoolly };
  enum class Bag : uint8_t { kNone, kRucksack, kShoulderBag };
  Hat hat = Hat::kNone;
  Bag bag = Bag::kNone;
  Eigen::Vector3f bag_size_m = Eigen::Vector3f(0.3F, 0.42F, 0.15F);
  float brim_m = 0.07F;   // how far it stands out
  float crown_m = 0.11F;  // height over the head's middle
  float on_left = 1.0F;   // 1: the shoulder bag hangs at the left, -1: at the right
};

/// A hat in one of three draws, a bag in one of four.
Accessories SampleAccessories(Random& random);

/// Its meshes in camera space on a posed body. A hat has the labels of the upper head, left and
/// right; a bag is an object, label 32; both are the user's.
std::vector<Prop> AccessoryProps(const Accessories& accessories, const recon::RigPose& pose,
                                 const recon::Posture& joints_in_cam, double height_m,
                                 const Eigen::Isometry3d& camera_from_world, uint8_t user);

}  // namespace ossa::tools
