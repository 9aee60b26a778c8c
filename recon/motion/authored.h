#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "recon/body/rig.h"

namespace ossa::recon {

// Constants: by convention (30 Hz, a Kinect SDK's rate; seed 1), the rest chosen by hand.

struct AuthoredOptions {
  uint64_t seed = 1;
  double frame_s = 1.0 / 30.0;
  int variations = 12;  // clips per action, each with another performer style
};

/// ossa's own clips: key postures written by hand, not taken from any recording, animated with
/// balance, foot contact and inverse kinematics in varying performer styles. Named
/// "authored/ACTION/N". Same options: same bytes.
std::vector<MotionClip> AuthoredClips(const AuthoredOptions& options = {});

/// Names of the actions, in the order of the clips.
std::vector<std::string> AuthoredActions();

}  // namespace ossa::recon
