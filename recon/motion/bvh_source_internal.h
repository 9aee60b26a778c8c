#pragma once
#include <string>

#include "recon/motion/bvh.h"
#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// A BVH as a motion to be retargeted.
SourceMotion ToSourceMotion(BvhFile file, const std::string& source);

}  // namespace ossa::recon
