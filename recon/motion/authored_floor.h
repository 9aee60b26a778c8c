#pragma once
#include <string>
#include <vector>

#include "recon/motion/authored.h"

namespace ossa::recon {

/// Motions beyond walking and gesturing: lying on back, belly and side, kneeling, sitting on the
/// floor, crouching, crawling, elbow to knee, arms behind the back, fast turns. Key postures
/// written by hand, with variation; named "authored-floor/ACTION/N". Same options: same bytes.
std::vector<MotionClip> AuthoredFloorClips(const AuthoredOptions& options = {});

/// Names of the actions, in the order of the clips.
std::vector<std::string> AuthoredFloorActions();

}  // namespace ossa::recon
