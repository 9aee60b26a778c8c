#pragma once
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

/// How far the skeleton may be from what is seen. Weights, confidences and reliabilities in [0, 1],
/// lengths and times > 0. Constants: by hand where nothing else is said.
struct HoldOptions {
  // Tracked joints keep within so much of the image, and so much more when their reliability is 0.
  double tracked_m = 0.02, unreliable_m = 0.04;
  // Inferred ones are off by 3 to 12 cm where the forest trusts them by 0.9 to 0 (measured in
  // rendered rooms), and may move by twice that.
  double inferred_m = 0.06, unsure_m = 0.18;
  double free_space_s = 0.05;  // time constant of the way out of free space, against flicker
  // A joint that is not tracked is a guess, which moves no faster against its parent: slower than
  // an arm that gestures, so that a guess that turns from one way to another does not leap. On real
  // video a sixth of the leaps is left, and rendered people are as near
  // (docs/benchmarks/tracking.md).
  double guess_m_s = 2.0;
  // What was seen, but by a later stage is so far away, was something else: of two to three tenths
  // of a metre real depth tells no difference.
  double elsewhere_m = 0.3;
  // Weights with which bones get their lengths again: of joints that are not seen, and the least of
  // those that are.
  double unseen = 0.1, least_seen = 0.2;
  double fitted_confidence = 0.3;  // of joints that only the fitted body knows: of a poor guess
  /// Share of the fitted body's bones in what a frame says of a person's; the rest is what the
  /// network for bones judges. On rendered people the mean of both is nearer than either.
  double fitted_bones = 0.7;
  double recent_s = 0.25;  // what was seen longer ago says nothing about now: a frame at 5 a second
  // Whose body the image's border cuts off so that fewer joints are seen than `mostly_seen` is not
  // believed to be elsewhere all of a sudden (median of the joints told), for so long.
  size_t mostly_seen = 12;
  double jump_m = 0.05, fastest_m_s = 3.0;  // anthropometry: a trunk's speed, running
  double disbelieved_s = 1.0;
};

/// Whether what was seen `since_s` ago still says something about now. Of another recording, whose
/// times were later, it does not.
bool IsRecent(double since_s, const HoldOptions& options);

/// What the tracker remembers of one person.
struct Person {
  int id = 0;
  double seen_s = 0.0;
  double before_s = -1e9;  // time of `before`
  recon::BoneLengths lengths_m = AverageBoneLengths();
  // By the estimates of the cascade until now.
  recon::BoneLengthEstimator bones{recon::BoneLengthOptions::ForNetworkEstimates()};
  std::optional<recon::TrackedPosture> before;  // of the last frame it was tracked in
  std::optional<recon::Posture> shown;          // what left in the last frame, at
  double shown_s = -1e9;
  double believed_s = -1e9;             // time of the last frame that was not disbelieved,
  size_t believed_joints = 0;           // ... and how many were tracked in it
  recon::StationaryPosture stationary;  // averages what stands still
  std::unique_ptr<recon::SurfaceFitter> fitter;
  recon::PersonShape shape;  // by surface fits until now
  std::unique_ptr<recon::Reconstructor> reconstructor;
  std::unique_ptr<Mechanics> mechanics;
  recon::JointArray<Eigen::Vector3d> occlusion_offset_m = NoMoves();  // out of free space
  SmoothingState smoothing;

  static recon::JointArray<Eigen::Vector3d> NoMoves() {
    recon::JointArray<Eigen::Vector3d> none;
    none.fill(Eigen::Vector3d::Zero());
    return none;
  }
};

/// Forgets who was out of view for more than `forget_s`, and of those not in view (`in_view`: ids)
/// who was seen later than now: time went back, this is another recording, and whoever has that id
/// in it may be anybody.
void ForgetGone(const std::vector<int>& in_view, double time_s, double forget_s,
                std::map<int, Person>& people);

/// What the stages from a detection to the skeleton read, the same for every person and frame.
struct SkeletonOptions {
  const forest::ForestModel* forest = nullptr;       // of choosing among proposals,
  people::JointTargets targets{};                    // ... and what it calls joints
  const recon::JointRefiner* refinement = nullptr;   // null: none
  const recon::PoseNetwork* pose_network = nullptr;  // null: none
  const recon::BodySurface* surface = nullptr;       // of `fit`
  std::optional<recon::SurfaceFitOptions> fit;       // nothing: no fit
  TrackingMode mode = TrackingMode::kStanding;
  bool from_above = false;  // the camera hangs under the ceiling
  bool physics = false;
  bool scene = false;  // people go on into one
  MechanicsBuild mechanics;
  SmoothingOptions smoothing;
  HoldOptions hold;
  recon::ReconstructorOptions reconstructor;
  std::map<int, recon::BoneLengths> bones_m;  // known ones, by body id
};

/// The person's own method, which has the bones where they are known.
std::unique_ptr<recon::Reconstructor> MethodFor(int id, const SkeletonOptions& options);

}  // namespace ossa::tracker
