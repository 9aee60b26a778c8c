#pragma once
#include <functional>
#include <map>
#include <memory>

#include "recon/methods/reconstructor.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Bone lengths by body id.
using BoneLengthsById = std::map<int, BoneLengths>;

/// Reconstructs a recording, with one Reconstructor per person (body id), in the order of its
/// frames.
/// Methods with revision give each frame as revised one frame later. Frames without bodies stay
/// empty; a person who was away for a minute counts as a new one. Each joint of the result has a
/// position, a reliability and a state: tracked joints that are reliable (over one half) and were
/// moved by less than 15 cm stay tracked, all others are inferred. Each bone has an orientation
/// (recon/orientation.h). `progress` (may be empty) is called with the number of frames done and
/// returns false to stop. `bones`: known bone lengths by person, used instead of options.bones_m.
/// Throws InputError as MakeReconstructor does, and for a frame with two bodies of the same id.
SkeletonSequence ReconstructSequence(const SkeletonSequence& sequence,
                                     const ReconstructorOptions& options,
                                     const std::function<bool(size_t)>& progress = {},
                                     const BoneLengthsById& bones = {});

/// Estimates each person's bone lengths from the whole recording, so that a reconstruction with
/// them has the same ones in every frame. Empty for methods that filter joints one by one.
BoneLengthsById MeasureBones(const SkeletonSequence& sequence, const ReconstructorOptions& options,
                             const std::function<bool(size_t)>& progress = {});

}  // namespace ossa::recon
