#pragma once
#include <string>
#include <vector>

#include "recon/motion/authored.h"

namespace ossa::recon {

/// What people do whom walking and gesturing do not show: lie down on back, belly and side, kneel,
/// sit on the floor, crouch, crawl, bring an elbow to a knee, hold their arms behind the back, turn
/// fast. Key postures put down by hand, with variation; named "authored-floor/ACTION/N". Same
/// options: same bytes.
std::vector<MotionClip> AuthoredFloorClips(const AuthoredOptions& options = {});

/// Names of the actions, in the order of the clips.
std::vector<std::string> AuthoredFloorActions();

}  // namespace ossa::recon
