#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "recon/body/rig.h"

namespace ossa::recon {

// Constants: by convention: 30 Hz and seed 1; AMC as its libraries state.

struct MocapOptions {
  double frame_s = 1.0 / 30.0;  // clips are resampled to this step
  uint64_t seed = 1;            // variation of the authored clips
  /// Frame rate of AMC files, which do not state it, Hz; 0: 120, as CMU and HDM05 publish them,
  /// with a warning in the first such clip.
  double amc_hz = 0.0;
  std::string mapping_file;  // bone names of an unknown conversion; "" = the known ones only
  /// Called before each file; true ends the reading, and the clips read so far are returned.
  std::function<bool()> stop = {};
};

/// Loads every clip of the sources: a folder of BVH, of AMC beside their ASF, of pybullet humanoid
/// JSON texts, or the words "authored" and "authored-floor" (ossa's own key postures with seeded
/// variation: upright; lying, kneeling, crawling). Clips are sorted by name. Throws InputError
/// naming file and line.
std::vector<MotionClip> LoadMocap(const std::vector<std::string>& sources,
                                  const MocapOptions& options = {});

}  // namespace ossa::recon
