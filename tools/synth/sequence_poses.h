#pragma once
#include <cstdint>
#include <vector>

#include "recon/body/rig.h"

namespace ossa::tools {

/// At least one clip's worth of consecutive poses for `frames` frames, drawn by seed among the
/// clips that are long enough and stay within view; facing +z at the start, around the origin.
std::vector<recon::RigPose> SequencePoses(const std::vector<recon::MotionClip>& clips,
                                          int64_t frames, uint64_t seed);

}  // namespace ossa::tools
