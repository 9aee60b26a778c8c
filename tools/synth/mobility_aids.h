#pragma once
#include <vector>

#include "depth/base/random.h"
#include "recon/body/rig.h"
#include "recon/posture.h"
#include "tools/synth/props.h"

namespace ossa::tools {

/// Wheelchairs and crutches: what people sit in or walk on, part 32. World: y up, floor at y = 0;
/// joints in world, metres.

/// Bends the legs to a seat's, feet before it, and lowers the hips to where a wheelchair has them.
/// The trunk must be upright.
void SitDown(recon::RigPose* pose, Random& random);

/// Whether the left hand is where that of somebody on crutches is: beside the body, a little before
/// it, the elbow slightly bent.
bool HoldsCrutch(const recon::RigPose& pose);

/// The chair of somebody who sits in it: seat, back with handles, arms, two large wheels with
/// spokes and hand rims, two castors, footplates.
std::vector<Prop> SampleWheelchair(const recon::Posture& joints_in_world, Random& random);

/// One crutch or, more often, two: from the floor to the hand and on to a cuff at the forearm, or
/// to the armpit. Each goes along with its hand.
std::vector<Prop> SampleCrutches(const recon::Posture& joints_in_world, Random& random);

}  // namespace ossa::tools
