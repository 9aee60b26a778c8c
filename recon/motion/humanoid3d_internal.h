#pragma once
#include <string>

#include "recon/motion/source_motion_internal.h"

namespace ossa::recon {

/// A motion of pybullet's DeepMimic humanoid (humanoid3d_*.txt): JSON {Loop, Frames}, each frame 44
/// numbers: seconds to the next frame, root position (metres, y up), root quaternion w x y z, then
/// joint rotations relative to their parents: chest 4, neck 4, right hip 4, knee 1, ankle 4,
/// shoulder 4, elbow 1, and the same for the left side. The rest pose stands with hanging arms,
/// facing +x.
SourceMotion ParseHumanoid3d(const std::string& text, const std::string& source);

}  // namespace ossa::recon
