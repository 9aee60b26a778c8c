#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "recon/body/rig.h"

namespace ossa::recon {

// Constants: by convention: 30 Hz and seed 1; AMC as its libraries say.

struct MocapOptions {
  double frame_s = 1.0 / 30.0;  // clips are resampled to this step
  uint64_t seed = 1;            // variation of the authored clips
  /// Frames a second of AMC files, which do not say; 0: 120, at which CMU and HDM05 publish, and
  /// the first such clip has a warning of it.
  double amc_hz = 0.0;
  std::string mapping_file;  // bone names of an unknown conversion; "" = the known ones only
  /// Asked before each file; true: no more are read, and those until then are what is returned.
  std::function<bool()> stop = {};
};

/// Loads every clip of the sources: a folder of BVH, of AMC beside their ASF, of pybullet humanoid
/// JSON texts, or the words "authored" and "authored-floor" (key postures with seeded variation,
/// ossa's own: upright, and lying, kneeling, crawling and the like). Clips come
/// sorted by name, so the same input gives the same list. Throws InputError naming file and line.
std::vector<MotionClip> LoadMocap(const std::vector<std::string>& sources,
                                  const MocapOptions& options = {});

}  // namespace ossa::recon
