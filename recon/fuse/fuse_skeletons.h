#pragma once
#include <span>

#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Options for fusing the skeletons of several cameras. Metres and seconds, all > 0.
struct FuseOptions {
  double max_gap_s = 0.1;  // longest gap to interpolate over; by hand: 3 frames
  /// Distance of a joint above which cameras contradict each other; by definition of confidence.
  double disagreement_m = 0.1;
  bool keep_bones = true;  // constant bone lengths over the whole recording
};

/// Fuses recordings of several cameras into one. `sequences` in the order and number of `cameras`,
/// camera 0 first. The result has camera 0's frames, with its times, floors and objects, in camera
/// 0's space. Another camera's bodies are interpolated at the same time by its clock offset. Gaps
/// of more than `max_gap_s`, or a frame and a half of a slower recording, are not bridged.
/// Coinciding bodies are one person, who keeps one id. People seen by one camera are included;
/// bodies without a position (HasPlace) are not. Joints are fused one by one: a tracked one before
/// an inferred one, weighted by certainty (standard deviations, else confidence, reliability and
/// the direction of the ray); if cameras contradict each other, the likeliest. People with all 20
/// joints who were seen by several cameras get constant median bone lengths. `warnings` name
/// cameras whose times do not overlap camera 0's. A single sequence is returned unchanged. Throws
/// std::invalid_argument if the counts differ.
SkeletonSequence FuseSkeletons(std::span<const SkeletonSequence> sequences,
                               const Extrinsics& cameras, const FuseOptions& options = {});

}  // namespace ossa::recon
