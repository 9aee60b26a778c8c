#pragma once
#include <functional>
#include <map>
#include <memory>

#include "recon/methods/reconstructor.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Bone lengths by body id.
using BoneLengthsById = std::map<int, BoneLengths>;

/// Runs one Reconstructor a person (by body id) over a recording, frame by frame in its order. A
/// frame holds what the method thinks of it a frame later, where the method revises.
/// Frames without bodies stay empty; each bone has an orientation (recon/orientation.h), its turn
/// about itself the method's own where it has one; who was away for a minute is somebody new. Each
/// joint comes out with a position, its reliability and a state: tracked stays, everything that was
/// made up is inferred. `progress` (may be empty) is called with the number of frames done and
/// returns false to stop. `bones`: of the people whose bones are known, in place of
/// options.bones_m. Throws InputError as MakeReconstructor does, and where a frame has two bodies
/// of one id.
SkeletonSequence ReconstructSequence(const SkeletonSequence& sequence,
                                     const ReconstructorOptions& options,
                                     const std::function<bool(size_t)>& progress = {},
                                     const BoneLengthsById& bones = {});

/// Offline: how long the bones of each person are, by the whole recording. Reconstructed with
/// these, a person has the same ones in every frame. Empty for methods that move joints alone.
BoneLengthsById MeasureBones(const SkeletonSequence& sequence, const ReconstructorOptions& options,
                             const std::function<bool(size_t)>& progress = {});

}  // namespace ossa::recon
