#pragma once
#include <cstdint>
#include <vector>

#include "recon/body/rig.h"

namespace ossa::tools {

/// Consecutive poses of one clip: `frames` of them, drawn by seed among the clips that are long
/// enough and stay within view, else all of the longest clip. Facing +z at the start, around the
/// origin.
std::vector<recon::RigPose> SequencePoses(const std::vector<recon::MotionClip>& clips,
                                          int64_t frames, uint64_t seed);

}  // namespace ossa::tools
