#pragma once
#include <optional>

#include "recon/methods/reconstructor.h"
#include "recon/posture.h"
#include "tools/people/detection.h"
#include "tools/tracker/person_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// One person in one frame on the way to the skeleton: what the stages read, and what each leaves
/// for those after it.
struct SkeletonWork {
  const SkeletonOptions& options;
  const depth::DepthFrame& frame;
  const std::optional<Eigen::Vector4d>& floor;
  const people::Detection* detection;  // of the first three stages; CompleteSkeleton needs none
  Person& person;                      // what was known before, and is from now on
  Body& body;                          // raw, refined, fit, reconstructed, joints, as they are made
  recon::TrackedPosture seen = {};     // raw, less what later stages contradict
  recon::TrackedPosture observed = {};             // what the method starts from,
  bool believed = true;                            // ... nothing, where it is not
  recon::ReconstructedPosture reconstructed = {};  // what it made of that,
  recon::Posture posture = {};                     // ... and the stages after it,
  // ... how its bones are turned about themselves, where the method or the character knows.
  std::optional<recon::JointOrientations> orientations = {};
};

/// From a detection to the skeleton: all stages, in the order of docs/pipeline.md. Adds the time of
/// each to `ms`.
void TrackSkeleton(SkeletonWork& work, StageTimes& ms);

/// The stages after body.raw, body.refined and body.fit are known.
void CompleteSkeleton(SkeletonWork& work, StageTimes& ms);

/// Chooses among the detection's proposals: body.raw.
void ChooseRaw(SkeletonWork& work);
/// Refines it at the depth image where there is a cascade or a pose network: body.refined.
void Refine(SkeletonWork& work);
/// Fits the body's surface where that is asked for: body.fit.
void Fit(SkeletonWork& work);
/// Leaves out joints that the tracking mode does not follow, and remembers the rest.
void ApplyMode(SkeletonWork& work);
/// Doubts what was seen and is said to be elsewhere, `seen`, and averages joints that stand still:
/// `observed`.
void AverageStationary(SkeletonWork& work);
/// The method of reconstruction: body.reconstructed.
void Reconstruct(SkeletonWork& work);
/// Holds joints to the image, moves them out of free space, smooths, keeps bones: `posture`.
void SmoothPosture(SkeletonWork& work);
/// From the ceiling: legs that are not seen, of joints that were not refined, stand on the floor:
/// `posture`.
void StandOnFloor(SkeletonWork& work);
/// The physical character, where it is on: `posture`.
void Simulate(SkeletonWork& work);
/// What leaves: body.joints.
void Finish(SkeletonWork& work);

}  // namespace ossa::tracker
