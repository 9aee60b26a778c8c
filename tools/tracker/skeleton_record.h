#pragma once
#include <string_view>

#include "recon/skeleton_sequence.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Which of a body's postures a file gets: its joints, or what a stage before made.
enum class PostureKind { kFinal, kReconstructed, kFitted, kRefined, kRaw };
/// final, reconstructed, fitted, refined or raw. Throws InputError for another.
PostureKind ParsePostureKind(std::string_view name);

/// The bodies of a frame as skeleton files hold them. Not-tracked joints keep the reconstruction's
/// position and say not_tracked; in raw and refined records they are absent. Refined records are
/// raw ones where there was no refinement. Fitted records have joints with their standard
/// deviations, and none of a body that was not fitted. Bodies known by position only are left out.
recon::SkeletonFrame ToRecord(const BodyFrame& frame, PostureKind kind = PostureKind::kFinal);

/// Of people who are tracked seated: the joints that nobody looks for become absent.
void KeepSeatedJoints(recon::SkeletonFrame& record);

}  // namespace ossa::tracker
