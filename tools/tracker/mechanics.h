#pragma once
#include <functional>

#include "recon/skeleton_sequence.h"

namespace ossa::tracker {

/// How a person's mechanical character is built (physics/character_filter.h).
struct MechanicsBuild {
  bool motors = false;        // servo motors instead of the papers' bounded forces
  bool hinges = false;        // elbows and knees are hinges instead of ball joints
  bool joint_limits = false;  // joints keep to the ranges that people's have
};

/// Lets one mechanical character a body id follow a recording (Shum 2013 sec. VII): all 20 joints
/// come out with orientations, bones of constant length, above each frame's floor where it has one
/// (one that lies 0.2 m and more above the person's lowest joint is another thing's top).
/// Joints' reliabilities say how far the character is led by them; joints that were absent come out
/// inferred. `progress` (may be empty) is called with the number of frames done and returns false
/// to stop.
void FollowMechanically(recon::SkeletonSequence& sequence, const MechanicsBuild& build,
                        const std::function<bool(size_t)>& progress = {});

}  // namespace ossa::tracker
