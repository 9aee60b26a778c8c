#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"
#include "recon/posture.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// What the first person of a still does with things: the arms go to them, and they to the hands.
enum class Interaction {
  kNone,
  kHeldUp,      // holds a sheet of cloth, a garment, a board, paper or a box up before the body
  kAtDesk,      // forearms lie on a desk, with things on it
  kArmrests,    // ... or on a chair's arms
  kWheelchair,  // sits in one
  kCrutches,    // walks on one or two
};

/// What `ossa render --occluders` asks for in this frame, by chance where it leaves a choice.
Interaction DrawInteraction(Occluders kind, Random& random);

/// Brings the arms to where the interaction has them. A trunk that lies or leans far cannot: then
/// the pose stays and kNone is returned.
Interaction ArrangeArms(Interaction interaction, recon::RigPose* pose, Random& random);

/// The things, in camera space, of a person whose arms are arranged. World: y up, floor at y = 0.
std::vector<Prop> InteractionProps(Interaction interaction, const recon::Posture& joints_in_world,
                                   const Eigen::Isometry3d& camera_from_world, Random& random);

}  // namespace ossa::tools
