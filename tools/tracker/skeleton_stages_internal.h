#pragma once
#include <optional>

#include "recon/methods/reconstructor.h"
#include "recon/posture.h"
#include "tools/people/detection.h"
#include "tools/tracker/person_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// One person in one frame: inputs and results of the skeleton stages.
struct SkeletonWork {
  const SkeletonOptions& options;
  const depth::DepthFrame& frame;
  const std::optional<Eigen::Vector4d>& floor;
  const people::Detection* detection;  // for the first three stages; null in CompleteSkeleton
  Person& person;                      // state from the frames before, updated
  Body& body;                       // raw, refined, fit, reconstructed, joints, set by the stages
  recon::TrackedPosture seen = {};  // raw, with joints that later stages contradict as inferred
  recon::TrackedPosture observed = {};             // the input of the method,
  bool believed = true;                            // ... without tracked joints if false
  recon::ReconstructedPosture reconstructed = {};  // the result of the method
  recon::Posture posture = {};                     // the current posture after each stage
  // Bone orientations, where the method or the character gives them.
  std::optional<recon::JointOrientations> orientations = {};
};

/// Runs all stages from detection to skeleton, in the order of docs/pipeline.md, and adds their
/// times to `ms`.
void TrackSkeleton(SkeletonWork& work, StageTimes& ms);

/// Runs the stages after body.raw, body.refined and body.fit are set.
void CompleteSkeleton(SkeletonWork& work, StageTimes& ms);

/// Chooses among the detection's proposals: body.raw.
void ChooseRaw(SkeletonWork& work);
/// Refines it at the depth image where there is a cascade or a pose network: body.refined.
void Refine(SkeletonWork& work);
/// Fits the body's surface where that is asked for: body.fit.
void Fit(SkeletonWork& work);
/// Marks joints outside the tracking mode as not tracked, and updates bone lengths from the rest.
void ApplyMode(SkeletonWork& work);
/// Sets `seen`, in which contradicted joints are inferred, and averages stationary joints:
/// `observed`.
void AverageStationary(SkeletonWork& work);
/// The method of reconstruction: body.reconstructed.
void Reconstruct(SkeletonWork& work);
/// Holds joints to the image, moves them out of free space, smooths, keeps bones: `posture`.
void SmoothPosture(SkeletonWork& work);
/// From the ceiling: places unseen, unrefined legs on the floor: `posture`.
void StandOnFloor(SkeletonWork& work);
/// Turns the bones of somebody on the floor up, out of it: `posture`.
void KeepAboveFloor(SkeletonWork& work);
/// Simulates the character, where physics is on: `posture`.
void Simulate(SkeletonWork& work);
/// Sets the result, body.joints.
void Finish(SkeletonWork& work);

}  // namespace ossa::tracker
