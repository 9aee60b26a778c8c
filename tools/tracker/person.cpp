#include "tools/tracker/person_internal.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "depth/base/statistics.h"
#include "recon/bone_projection.h"
#include "recon/orientation.h"
#include "recon/refine/free_space.h"
#include "tools/tracker/fit_surface_internal.h"
#include "tools/tracker/skeleton_stages_internal.h"

namespace ossa::tracker {
namespace {

// Constants: chosen by hand.

using recon::kJointCount;
using recon::TrackingState;

// Keeps joints near their observations. Unseen joints further out on the limb move along, so that
// the limb keeps its shape.
recon::Posture HoldToImage(const recon::Posture& posture, const recon::TrackedPosture& observed,
                           const recon::JointArray<double>& reliability,
                           const HoldOptions& options) {
  recon::Posture held = posture;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (observed.state[j] != TrackingState::kNotTracked) {
      const Eigen::Vector3d& seen = observed.posture.position_m[j];
      const bool tracked = observed.state[j] == TrackingState::kTracked;
      const double radius_m =
          tracked ? options.tracked_m +
                        options.unreliable_m * (1.0 - std::clamp(reliability[j], 0.0, 1.0))
                  : options.inferred_m +
                        options.unsure_m * (1.0 - std::clamp(observed.confidence[j], 0.0, 1.0));
      const Eigen::Vector3d off = posture.position_m[j] - seen;
      const double share = off.norm() > radius_m ? radius_m / off.norm() : 1.0;
      held.position_m[j] = seen + off * share;
    } else if (j > 0) {
      const size_t p = recon::ParentOf(j);
      held.position_m[j] = held.position_m[p] + (posture.position_m[j] - posture.position_m[p]);
    }
  }
  return held;
}

// Unseen joints must be occluded: moves them out of free space, gradually, so that an unsteady
// estimate does not flicker. Seen joints are not displaced.
recon::Posture MoveUnseenOutOfFreeSpace(recon::Posture posture,
                                        const recon::TrackedPosture& observed,
                                        const depth::DepthFrame& frame, const HoldOptions& options,
                                        Person& person) {
  const double share =
      1.0 - std::exp(-std::max(0.0, frame.time_s - person.before_s) / options.free_space_s);
  for (size_t j = 0; j < kJointCount; ++j) {
    if (observed.state[j] == TrackingState::kTracked) {
      person.occlusion_offset_m[j].setZero();
      continue;
    }
    Eigen::Vector3d& place = posture.position_m[j];
    person.occlusion_offset_m[j] +=
        share * (recon::MoveOutOfFreeSpace(place, frame) - place - person.occlusion_offset_m[j]);
    place += person.occlusion_offset_m[j];
  }
  return posture;
}

// Limits the speed of joints that are not tracked, relative to their parents.
recon::Posture LimitUnseenSpeed(const recon::Posture& posture, const SkeletonWork& work) {
  const Person& person = work.person;
  const HoldOptions& options = work.options.hold;
  const double since_s = work.frame.time_s - person.shown_s;
  if (!person.shown || !IsRecent(since_s, options)) return posture;
  const double farthest_m = options.guess_m_s * std::max(0.0, since_s);
  recon::Posture slow = posture;
  for (size_t j = 1; j < kJointCount; ++j) {
    if (work.seen.state[j] == TrackingState::kTracked) continue;
    const size_t p = recon::ParentOf(j);
    const Eigen::Vector3d before_m = person.shown->position_m[j] - person.shown->position_m[p];
    const Eigen::Vector3d moved_m = posture.position_m[j] - posture.position_m[p] - before_m;
    const double share = std::min(1.0, farthest_m / std::max(moved_m.norm(), 1e-9));
    slow.position_m[j] = slow.position_m[p] + before_m + share * moved_m;
  }
  return slow;
}

// Restores the bone lengths of `whole`, which moving joints one by one changes; unseen joints move
// most.
recon::Posture RestoreBoneLengths(const recon::Posture& whole, const recon::Posture& moved,
                                  const recon::TrackedPosture& observed,
                                  const recon::JointArray<double>& reliability,
                                  const HoldOptions& options) {
  recon::JointWeights weights;
  for (size_t j = 0; j < kJointCount; ++j) {
    const bool seen = observed.state[j] == TrackingState::kTracked;
    weights[j] = seen ? options.least_seen + std::clamp(reliability[j], 0.0, 1.0) : options.unseen;
  }
  return recon::WithBoneLengths(moved, recon::MeasureBoneLengths(whole), weights);
}

// `turns`: orientations by the method or the character, which know rotations about the bones.
recon::JointArray<JointEstimate> MakeJointEstimates(
    const recon::Posture& posture, const std::optional<recon::JointOrientations>& turns,
    const recon::TrackedPosture& observed, const recon::JointArray<double>& reliability) {
  const recon::JointOrientations orientation =
      turns ? recon::AlignToBones(*turns, posture) : recon::ComputeOrientations(posture);
  recon::JointArray<JointEstimate> joints;
  for (size_t j = 0; j < kJointCount; ++j) {
    joints[j] = {posture.position_m[j], orientation[j], observed.state[j], observed.confidence[j],
                 reliability[j]};
  }
  return joints;
}

// The input of the reconstruction method: the joints of the latest stage. A surface fit gives all
// joints, also unseen ones; but if the trunk is outside the image, the method's own memory is more
// accurate.
recon::TrackedPosture SelectObservation(const Body& body, bool refined, const depth::Camera& camera,
                                        double fitted_confidence) {
  recon::TrackedPosture seen = body.raw;
  if (body.refined && refined) seen.posture = *body.refined;
  if (!body.fit) return seen;
  seen.posture = body.fit->blended_m;
  if (!IsInImage(camera, body.fit->joints_m[recon::Joint::kSpine])) return seen;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (seen.state[j] != TrackingState::kNotTracked) continue;
    seen.state[j] = TrackingState::kInferred;
    seen.confidence[j] = fitted_confidence;
  }
  return seen;
}

// Marks tracked joints as inferred where refinement and fit moved them far: a desk's corner may be
// classified as a foot.
recon::TrackedPosture InferContradicted(const Body& body, const depth::Camera& camera,
                                        double elsewhere_m) {
  recon::TrackedPosture seen = body.raw;
  if (body.fit) {
    InferElsewhere(body.fit->blended_m, camera, elsewhere_m, seen);
  } else if (body.refined) {
    InferElsewhere(*body.refined, camera, elsewhere_m, seen);
  }
  return seen;
}

size_t CountTracked(const recon::TrackedPosture& posture) {
  return static_cast<size_t>(std::ranges::count(posture.state, TrackingState::kTracked));
}

// Whether a person who is increasingly cut off by the image border jumps: the visible part was
// classified as another part of the body.
bool JumpsAtTheBorder(const Body& body, const recon::TrackedPosture& observed, double time_s,
                      const HoldOptions& options, const Person& person) {
  if (body.clipped_edges == 0 || !person.shown) return false;
  const double since_s = time_s - person.shown_s;
  if (!IsRecent(since_s, options)) return false;
  if (time_s - person.believed_s > options.disbelieved_s) return false;
  if (CountTracked(observed) >= std::min(options.mostly_seen, person.believed_joints)) return false;
  recon::JointArray<double> off_m{};
  size_t told = 0;
  for (size_t j = 0; j < kJointCount; ++j) {
    if (observed.state[j] == TrackingState::kNotTracked) continue;
    off_m[told++] = (observed.posture.position_m[j] - person.shown->position_m[j]).norm();
  }
  return told > 0 && SelectRank(std::span(off_m).first(told), told / 2) >
                         options.jump_m + options.fastest_m_s * std::max(0.0, since_s);
}

// Without observations the method extrapolates.
void MarkNotTracked(recon::TrackedPosture& observed) {
  observed.state.fill(TrackingState::kNotTracked);
  observed.confidence.fill(0.0);
}

// Observations that the method rejected constrain no joint.
void ApplyGrossFailure(SkeletonWork& work) {
  const recon::GrossFailure failure = work.reconstructed.failure;
  if (failure == recon::GrossFailure::kSidesExchanged) {
    work.observed = recon::SidesExchanged(work.observed);
    work.seen = recon::SidesExchanged(work.seen);
  }
  if (failure == recon::GrossFailure::kAnotherBody) {
    work.believed = false;
    MarkNotTracked(work.observed);
  }
}

// The bone lengths of this frame: mean of the fitted body and the network.
std::optional<recon::BoneLengths> JudgeBones(const Body& body, double fitted_share) {
  if (!body.fit) return body.refined_bones_m;
  recon::BoneLengths bones_m = recon::MeasureBoneLengths(body.fit->joints_m);
  if (!body.refined_bones_m) return bones_m;
  for (size_t j = 0; j < kJointCount; ++j) {
    bones_m[j] = fitted_share * bones_m[j] + (1.0 - fitted_share) * (*body.refined_bones_m)[j];
  }
  return bones_m;
}

// Lowers the trust in joints without surface where the fitted body has it.
void DoubtByResidual(const SkeletonWork& work, recon::JointArray<double>& trust) {
  const auto& options = work.options.fit;
  if (!work.body.fit || !options || !(options->doubt_residual_m > 0.0)) return;
  DoubtUnexplained(*work.body.fit, *work.options.surface, options->doubt_residual_m, trust);
}

}  // namespace

recon::Posture ToPosture(const Body& body) {
  recon::Posture posture;
  for (size_t j = 0; j < kJointCount; ++j) posture.position_m[j] = body.joints[j].position_m;
  return posture;
}

recon::JointOrientations ComputeHierarchicalOrientations(const Body& body) {
  recon::JointOrientations absolute;
  for (size_t j = 0; j < kJointCount; ++j) absolute[j] = body.joints[j].orientation;
  return recon::ToHierarchical(absolute);
}

bool IsRecent(double since_s, const HoldOptions& options) {
  return since_s > -recon::FrameSteps::kJitter_s && since_s <= options.recent_s;
}

bool IsSeatedJoint(recon::Joint joint) {
  return recon::Index(joint) >= recon::Index(recon::Joint::kShoulderCenter) &&
         recon::Index(joint) <= recon::Index(recon::Joint::kHandRight);
}

void DeleteGone(const std::vector<int>& in_view, double time_s, double forget_s,
                std::map<int, Person>& people) {
  std::erase_if(people, [&](const auto& entry) {
    const auto& [id, person] = entry;
    const bool is_in_view = std::find(in_view.begin(), in_view.end(), id) != in_view.end();
    const double later_s = person.seen_s - time_s;
    return -later_s > forget_s || (later_s >= recon::FrameSteps::kJitter_s && !is_in_view);
  });
}

std::unique_ptr<recon::Reconstructor> MethodFor(int id, const SkeletonOptions& options) {
  recon::ReconstructorOptions with = options.reconstructor;
  const auto known = options.bones_m.find(id);
  if (known != options.bones_m.end()) with.bones_m = known->second;
  return recon::MakeReconstructor(with);
}

void AverageStationary(SkeletonWork& work) {
  const recon::MethodInfo& method = recon::RequireMethod(work.options.reconstructor.method);
  const HoldOptions& hold = work.options.hold;
  const depth::Camera& camera = work.frame.camera;
  work.seen = InferContradicted(work.body, camera, hold.elsewhere_m);
  recon::TrackedPosture observed =
      SelectObservation(work.body, method.refined, camera, hold.fitted_confidence);
  DoubtByResidual(work, observed.confidence);
  Person& person = work.person;
  work.believed = !JumpsAtTheBorder(work.body, observed, work.frame.time_s, hold, person);
  const size_t tracked = CountTracked(observed);
  if (work.believed && tracked > 0) {
    person.believed_s = work.frame.time_s;
    person.believed_joints = tracked;
  }
  if (!work.believed) MarkNotTracked(observed);
  work.observed = person.stationary.Step(observed, work.frame.time_s);
}

void Reconstruct(SkeletonWork& work) {
  auto& method = work.person.reconstructor;
  Body& body = work.body;
  if (!method) method = MethodFor(body.id, work.options);
  work.reconstructed = method->Step({work.observed, work.frame.time_s, &work.frame,
                                     JudgeBones(body, work.options.hold.fitted_bones), work.floor});
  ApplyGrossFailure(work);
  DoubtByResidual(work, work.reconstructed.reliability);
  body.reconstructed = work.reconstructed.posture;
  body.bones_m = method->Bones();
  work.posture = body.reconstructed;
  work.orientations = work.reconstructed.orientation;
}

void SmoothPosture(SkeletonWork& work) {
  const auto& reliability = work.reconstructed.reliability;
  const recon::Posture held =
      HoldToImage(work.posture, work.observed, reliability, work.options.hold);
  recon::Posture smoothed = Smooth(
      MoveUnseenOutOfFreeSpace(held, work.observed, work.frame, work.options.hold, work.person),
      work.frame.time_s, work.options.smoothing, work.person.smoothing);
  const SkeletonOptions& options = work.options;
  const recon::MethodInfo& method = recon::RequireMethod(options.reconstructor.method);
  if (method.refined) smoothed = LimitUnseenSpeed(smoothed, work);
  if (options.physics || options.scene || method.keeps_bones) {
    smoothed = RestoreBoneLengths(work.posture, smoothed, work.observed, reliability, options.hold);
  }
  work.posture = smoothed;
}

// After the joints are held to the image, so that the result obeys floor, joint limits and bone
// lengths.
void Simulate(SkeletonWork& work) {
  if (!work.options.physics) return;
  auto& mechanics = work.person.mechanics;
  if (!mechanics) {
    mechanics = std::make_unique<Mechanics>(work.options.mechanics, kFollowing_rad_s);
  }
  const auto made = mechanics->Follow(work.posture, work.reconstructed.reliability, work.floor,
                                      work.frame.time_s, work.orientations);
  if (!made) return;
  work.posture = made->posture;
  work.orientations = made->orientation;
}

void Finish(SkeletonWork& work) {
  recon::TrackedPosture told = work.seen;
  if (!work.believed) {
    std::ranges::replace(told.state, TrackingState::kTracked, TrackingState::kInferred);
  }
  InferElsewhere(work.posture, work.frame.camera, work.options.hold.elsewhere_m, told);
  // At the observation, not at the result: a smoothed joint that lags behind was seen all the same.
  InferSeenThrough(work.observed.posture, work.frame, told);
  work.body.joints =
      MakeJointEstimates(work.posture, work.orientations, told, work.reconstructed.reliability);
  work.person.shown = work.posture;
  work.person.shown_s = work.frame.time_s;
}

}  // namespace ossa::tracker
