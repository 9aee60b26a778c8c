#pragma once
#include "depth/base/random.h"
#include "recon/body/rig.h"

namespace ossa::tools {

/// A posture nobody was recorded in: trunk, head, arms and legs anywhere within the limits of their
/// joints, standing, bent, or lying on back, belly or side, on the floor; facing +z over the
/// origin.
recon::RigPose RandomPosture(Random& random);

}  // namespace ossa::tools
