#include "tools/tracker/skeleton_stages_internal.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/base/stopwatch.h"
#include "recon/refine/fuse_poses.h"
#include "tools/people/pose_evidence.h"
#include "tools/tracker/choose_posture_internal.h"
#include "tools/tracker/fit_surface_internal.h"
#include "tools/tracker/refine_joints_internal.h"

namespace ossa::tracker {
namespace {

struct Stage {
  void (*run)(SkeletonWork&);
  double StageTimes::*ms;  // the timer it counts in
};

// docs/pipeline.md describes the stages and their effect.
constexpr std::array kStages = {
    Stage{ChooseRaw, &StageTimes::propose},
    Stage{Refine, &StageTimes::reconstruct},
    Stage{Fit, &StageTimes::fit},
    Stage{ApplyMode, &StageTimes::propose},
    Stage{AverageStationary, &StageTimes::reconstruct},
    Stage{Reconstruct, &StageTimes::reconstruct},
    Stage{SmoothPosture, &StageTimes::reconstruct},
    Stage{StandOnFloor, &StageTimes::reconstruct},
    Stage{KeepAboveFloor, &StageTimes::reconstruct},
    Stage{Simulate, &StageTimes::physics},
    Stage{Finish, &StageTimes::reconstruct},
};
constexpr size_t kObservingStages =
    4;  // by definition: the stages before those of CompleteSkeleton

void RunStages(std::span<const Stage> stages, SkeletonWork& work, StageTimes& ms) {
  for (const Stage& stage : stages) {
    const Stopwatch watch;
    stage.run(work);
    ms.*stage.ms += watch.milliseconds();
  }
}

void RefineByCascade(std::span<const uint8_t> is_person, SkeletonWork& work) {
  const auto refined = RefineJoints(is_person, work);
  if (!refined) return;
  work.body.refined = refined->joints_m;
  work.body.refined_bones_m = refined->bones_m;
}

// Joints without a chosen proposal have no position of their own; takes that of `others_m`.
recon::Posture FillMissing(const recon::TrackedPosture& raw, const recon::Posture& others_m) {
  recon::Posture whole_m = raw.posture;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (raw.state[j] != recon::TrackingState::kNotTracked) continue;
    whole_m.position_m[j] = others_m.position_m[j];
  }
  return whole_m;
}

// Uses the pose from detection, or runs the network now.
void FuseWithNetwork(SkeletonWork& work) {
  std::optional<recon::NetworkPose> network = work.detection->pose;
  if (!network) {
    network =
        people::ReadPose(*work.options.pose_network, work.frame, work.detection->candidate.pixels);
  }
  if (!network) return;
  Body& body = work.body;
  if (!body.refined) body.refined = FillMissing(body.raw, network->joints_m);
  body.refined = recon::FusePoses(*body.refined, body.raw.confidence, *network);
}

}  // namespace

void TrackSkeleton(SkeletonWork& work, StageTimes& ms) {
  RunStages(kStages, work, ms);
  ms.reconstruct += ms.fit;
  if (!work.believed) return;
  work.person.before = work.body.raw;
  work.person.before_s = work.frame.time_s;
}

void CompleteSkeleton(SkeletonWork& work, StageTimes& ms) {
  RunStages(std::span(kStages).subspan(kObservingStages), work, ms);
}

void ChooseRaw(SkeletonWork& work) {
  const Person& person = work.person;
  const people::ForestEvidence& evidence = work.detection->evidence;
  ChoiceContext context;
  context.camera = &work.frame.camera;
  context.expected_m = person.lengths_m;
  context.leg_area_m2 = evidence.leg_area_m2;
  const bool recent =
      person.before && IsRecent(work.frame.time_s - person.before_s, work.options.hold);
  context.before = recent ? &*person.before : nullptr;
  work.body.raw =
      ChoosePosture(*work.options.forest, work.options.targets, evidence.proposals, context);
}

void Refine(SkeletonWork& work) {
  const SkeletonOptions& options = work.options;
  if (options.refinement != nullptr) {
    RefineByCascade(people::MaskPixels(work.frame, work.detection->candidate.pixels), work);
  }
  if (options.pose_network != nullptr) FuseWithNetwork(work);
}

void Fit(SkeletonWork& work) {
  if (!work.options.fit) return;
  auto& fitter = work.person.fitter;
  if (!fitter) {
    fitter = std::make_unique<recon::SurfaceFitter>(*work.options.surface, *work.options.fit);
  }
  work.body.fit = FitSurface(work.frame, *work.detection, work.body, work.person);
  if (work.person.shape.frames > 0) work.body.shape = work.person.shape;
}

void ApplyMode(SkeletonWork& work) {
  recon::TrackedPosture& raw = work.body.raw;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const bool followed =
        work.options.mode == TrackingMode::kStanding || IsSeatedJoint(static_cast<recon::Joint>(j));
    if (followed) continue;
    raw.state[j] = recon::TrackingState::kNotTracked;
    raw.confidence[j] = 0;
  }
  LearnBoneLengths(raw, work.person.lengths_m);
}

}  // namespace ossa::tracker
