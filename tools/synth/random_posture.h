#pragma once
#include "depth/base/random.h"
#include "recon/body/rig.h"

namespace ossa::tools {

/// A random pose within the joint limits of trunk, head, arms and legs: standing, bent over, or
/// lying on back, belly or side, on the floor (y = 0); facing +z at the origin.
recon::RigPose RandomPosture(Random& random);

}  // namespace ossa::tools
