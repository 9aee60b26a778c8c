#pragma once
#include "recon/skeleton_sequence.h"

namespace ossa::tracker {

/// Lets one mechanical character a body id follow a recording (Shum 2013 sec. VII), by the papers'
/// bounded forces or by servo motors: all 20 joints come out with orientations, bones of constant
/// length, above each frame's floor where it has one. Joints' reliabilities say how far the
/// character is led by them; joints that were absent come out inferred.
void FollowMechanically(recon::SkeletonSequence& sequence, bool motors);

}  // namespace ossa::tracker
