#pragma once
#include <string_view>

#include "recon/skeleton_sequence.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Which of a body's postures is written: the final joints, or the result of an earlier stage.
enum class PostureKind { kFinal, kReconstructed, kFitted, kRefined, kRaw };
/// Parses final, reconstructed, fitted, refined or raw. Throws InputError for others.
PostureKind ParsePostureKind(std::string_view name);

/// The bodies of a frame as stored in skeleton files. Not-tracked joints have the reconstruction's
/// position and the state not_tracked; in raw and refined records they are absent. Refined records
/// equal raw ones where there was no refinement. Fitted records have standard deviations, and no
/// joints of a body that was not fitted. Bodies known by position only are left out.
recon::SkeletonFrame ToRecord(const BodyFrame& frame, PostureKind kind = PostureKind::kFinal);

/// Removes the joints that the seated mode does not track.
void KeepSeatedJoints(recon::SkeletonFrame& record);

}  // namespace ossa::tracker
