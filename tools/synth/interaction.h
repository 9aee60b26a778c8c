#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"
#include "recon/posture.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// Interaction of the first person of a single frame with objects: arms and objects are moved to
/// each other.
enum class Interaction {
  kNone,
  kHeldUp,      // holds cloth, a garment, a board, paper or a box up in front of the body
  kAtDesk,      // forearms on a desk with objects on it
  kArmrests,    // forearms on the armrests of a chair
  kWheelchair,  // sits in a wheelchair
  kCrutches,    // walks on one or two crutches
};

/// The interaction that `ossa render --occluders` requests, random if it allows several.
Interaction DrawInteraction(Occluders kind, Random& random);

/// Moves the arms (and for a wheelchair the legs) as the interaction needs. If the trunk lies or
/// leans too far, the pose stays unchanged and kNone is returned.
Interaction ArrangeArms(Interaction interaction, recon::RigPose* pose, Random& random);

/// The objects of the interaction, in camera space, after ArrangeArms(). World: metres, y up, floor
/// at y = 0.
std::vector<Prop> InteractionProps(Interaction interaction, const recon::Posture& joints_in_world,
                                   const Eigen::Isometry3d& camera_from_world, Random& random);

}  // namespace ossa::tools
