#pragma once
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "recon/bone_lengths.h"
#include "recon/filters/stationary_average.h"
#include "recon/fit/surface_fit.h"
#include "recon/methods/reconstructor.h"
#include "recon/refine/bone_estimation.h"
#include "recon/refine/pose_network.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/people/joint_targets.h"
#include "tools/tracker/choose_posture_internal.h"
#include "tools/tracker/mechanics_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Tolerances between the skeleton and the observed joints. Weights, confidences and reliabilities
/// in [0, 1], lengths and times > 0. Constants: by hand unless stated otherwise.
struct HoldOptions {
  // Largest distance of a tracked joint from its observation; unreliable_m is added at reliability
  // 0.
  double tracked_m = 0.02, unreliable_m = 0.04;
  // The same for inferred joints, whose error is 3 to 12 cm for the forest's confidence 0.9 to 0
  // (measured in rendered rooms): twice that.
  double inferred_m = 0.06, unsure_m = 0.18;
  double free_space_s =
      0.05;  // time constant of moving occluded joints out of free space, against flicker
  // Largest speed of a joint that is not tracked, relative to its parent: slower than a gesturing
  // arm, so that an estimate that changes does not jump. On real video a sixth of the jumps is
  // left, and rendered people are as accurate (docs/benchmarks/tracking.md).
  double guess_m_s = 2.0;
  // An observation that a later stage moves by more than this was another object: between two and
  // three tenths of a metre real depth shows no difference.
  double elsewhere_m = 0.3;
  // Weights when bone lengths are restored: of unseen joints, and the least of seen ones.
  double unseen = 0.1, least_seen = 0.2;
  double fitted_confidence = 0.3;  // of joints that only the fitted body has: as of a poor proposal
  /// Weight of the fitted body in a frame's bone lengths; the rest is the network's. On rendered
  /// people the mean is more accurate than either.
  double fitted_bones = 0.7;
  double recent_s = 0.25;  // older observations are not used: one frame at 5 Hz
  // A body cut off by the image border, with fewer tracked joints than mostly_seen, must not jump:
  // if the median displacement of its joints exceeds jump_m + fastest_m_s * dt, the observation is
  // ignored, for at most disbelieved_s.
  size_t mostly_seen = 12;
  double jump_m = 0.05, fastest_m_s = 3.0;  // anthropometry: a trunk's speed, running
  double disbelieved_s = 1.0;
};

/// Whether an observation `since_s` ago is still usable. One of another recording, with later
/// times, is not.
bool IsRecent(double since_s, const HoldOptions& options);

/// The state of one person between frames.
struct Person {
  int id = 0;
  double seen_s = 0.0;
  double before_s = -std::numeric_limits<double>::infinity();  // time of `before`
  recon::BoneLengths lengths_m = AverageBoneLengths();
  // From the estimates of the refinement cascade.
  recon::BoneLengthEstimator bones{recon::BoneLengthOptions::ForNetworkEstimates()};
  std::optional<recon::TrackedPosture> before;  // of the last tracked frame
  std::optional<recon::Posture> shown;          // the skeleton returned in the last frame, at ...
  double shown_s = -std::numeric_limits<double>::infinity();
  double believed_s =
      -std::numeric_limits<double>::infinity();  // time of the last accepted observation,
  size_t believed_joints = 0;                    // ... and its number of tracked joints
  recon::StationaryPosture stationary;           // averages stationary joints
  std::unique_ptr<recon::SurfaceFitter> fitter;
  recon::PersonShape shape;  // mean of the surface fits
  std::unique_ptr<recon::Reconstructor> reconstructor;
  std::unique_ptr<Mechanics> mechanics;
  recon::JointArray<Eigen::Vector3d> occlusion_offset_m =
      NoMoves();  // displacement out of free space
  SmoothingState smoothing;

  static recon::JointArray<Eigen::Vector3d> NoMoves() {
    recon::JointArray<Eigen::Vector3d> none;
    none.fill(Eigen::Vector3d::Zero());
    return none;
  }
};

/// Deletes people out of view for more than `forget_s`, and people not in view (`in_view`: ids) who
/// were last seen later than now: time went back, so in this recording the id may be another
/// person's.
void DeleteGone(const std::vector<int>& in_view, double time_s, double forget_s,
                std::map<int, Person>& people);

/// Input of the stages from detection to skeleton, the same for all people and frames.
struct SkeletonOptions {
  const forest::ForestModel* forest = nullptr;       // for the choice among proposals
  people::JointTargets targets{};                    // its targets for the joints
  const recon::JointRefiner* refinement = nullptr;   // null: none
  const recon::PoseNetwork* pose_network = nullptr;  // null: none
  const recon::BodySurface* surface = nullptr;       // of `fit`
  std::optional<recon::SurfaceFitOptions> fit;       // nothing: no fit
  TrackingMode mode = TrackingMode::kStanding;
  bool from_above = false;  // the camera is under the ceiling
  bool physics = false;
  bool scene = false;  // people are then simulated in a scene
  MechanicsBuild mechanics;
  SmoothingOptions smoothing;
  HoldOptions hold;
  recon::ReconstructorOptions reconstructor;
  std::map<int, recon::BoneLengths> bones_m;  // known ones, by body id
};

/// A new instance of the method for one person, with their bone lengths where these are known.
std::unique_ptr<recon::Reconstructor> MethodFor(int id, const SkeletonOptions& options);

}  // namespace ossa::tracker
