#pragma once
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"
#include "recon/posture.h"
#include "tools/synth/props.h"

namespace ossa::tools {

// Wheelchairs and crutches (part 32). World: metres, y up, floor at y = 0.

/// Changes an upright pose into one that sits in a wheelchair: legs bent, feet forward, hips at
/// seat height. The trunk must be upright.
void SitDown(recon::RigPose* pose, Random& random);

/// True if the left hand is where a person on crutches holds it: beside the body and slightly in
/// front of it, the elbow slightly bent.
bool HoldsCrutch(const recon::RigPose& pose);

/// The wheelchair of a seated person: seat, back with handles, armrests, two large wheels with
/// spokes and hand rims, two castors, footplates.
std::vector<Prop> SampleWheelchair(const recon::Posture& joints_in_world, Random& random);

/// One crutch or, more often, two: from the floor to the hand and on to a cuff at the forearm, or
/// to the armpit. Each moves with its hand.
std::vector<Prop> SampleCrutches(const recon::Posture& joints_in_world, Random& random);

}  // namespace ossa::tools
