#pragma once
#include <span>

#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// How the skeletons of several cameras become one. Metres and seconds, all > 0.
struct FuseOptions {
  double max_gap_s = 0.1;  // over which a camera's bodies are interpolated; by hand: 3 frames
  /// Of one joint, above which cameras contradict each other; what confidences are about: by
  /// definition.
  double disagreement_m = 0.1;
  bool keep_bones = true;  // bones have one length in the whole recording
};

/// One recording of what several cameras saw at once: `sequences` in the order of `cameras`, camera
/// 0 first, as many as these. The frames are camera 0's, with its times, floors and things;
/// skeletons are in its space. Another camera's bodies are taken at the same time by its clock
/// offset, on the line between two moments; where these are more than `max_gap_s` apart, or a frame
/// and a half of a slower recording, it says nothing of that time. Bodies that lie on each other
/// are one person, who keeps one id; people whom one camera sees are there, too; of bodies without
/// a place (HasPlace) nothing is left. Joints are fused
/// one by one: a tracked one before an inferred one, what is surer (standard deviations, else
/// confidence, reliability and the direction of the ray) before what is less; where cameras
/// contradict each other, the likeliest. People of whom all 20 joints are there and whom several
/// cameras saw keep the median lengths of their bones. `warnings` are of the fusion: of cameras
/// whose times are none of camera 0's. Of one sequence, that one. Throws std::invalid_argument
/// where the counts differ.
SkeletonSequence FuseSkeletons(std::span<const SkeletonSequence> sequences,
                               const Extrinsics& cameras, const FuseOptions& options = {});

}  // namespace ossa::recon
