#pragma once
#include <functional>

#include "recon/skeleton_sequence.h"

namespace ossa::tracker {

/// How a mechanical character is built (physics/character_filter.h).
struct MechanicsBuild {
  bool motors = false;        // servo motors instead of the papers' bounded forces
  bool hinges = false;        // elbows and knees are hinges instead of ball joints
  bool joint_limits = false;  // joints are limited to anatomical ranges
};

/// Simulates one mechanical character per body id that follows a recording (Shum 2013 sec. VII).
/// The result has all 20 joints with orientations, constant bone lengths, and stays above each
/// frame's floor where there is one (a plane 0.2 m or more above the person's lowest joint is taken
/// for the top of an object). A joint's reliability weights how strongly the character follows it;
/// absent joints become inferred. `progress` (may be empty) is called with the number of finished
/// frames and returns false to stop.
void FollowMechanically(recon::SkeletonSequence& sequence, const MechanicsBuild& build,
                        const std::function<bool(size_t)>& progress = {});

}  // namespace ossa::tracker
