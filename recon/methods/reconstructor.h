#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "recon/methods/method_table.h"
#include "recon/posture.h"

namespace ossa::recon {

/// Input of a method: one person at one time.
struct ReconstructionInput {
  TrackedPosture observed;  // camera space
  double time_s = 0.0;      // steps may be irregular, with gaps of seconds
  /// The depth image, if there is one: a surface at a joint's position, or its absence, tells an
  /// occluded joint from a wrong one. Borrowed for the call.
  const depth::DepthFrame* depth = nullptr;
  /// Bone lengths as cascaded refinement estimates them in this frame, metres
  /// (recon/refine/bone_estimation.h).
  std::optional<BoneLengths> bones_m = std::nullopt;
  /// a b c d of ax + by + cz + d = 0, unit normal up, camera space. Without it the vertical is
  /// estimated from the person.
  std::optional<Eigen::Vector4d> floor = std::nullopt;
  /// Transform of the observed joints to the depth image's space, if they are in another one.
  std::optional<Eigen::Isometry3d> camera_from_observed = std::nullopt;
};

/// Failures of the observation as a whole that a method may detect.
enum class GrossFailure {
  kNone,
  kSidesExchanged,  // left and right were swapped; the posture has them corrected
  kAnotherBody,     // an impossible motion; the observation was not used
};

/// Result of a method: one person at one time.
struct ReconstructedPosture {
  Posture posture;                   // camera space, all 20 joints finite
  JointArray<double> reliability{};  // R_i in [0, 1] of the observed joint, eq. 8
  /// Camera from bone (recon/orientation.h), from methods that know the bones' rotations about
  /// their own axes from a database; else empty, see ComputeOrientations.
  std::optional<JointOrientations> orientation = std::nullopt;
  GrossFailure failure = GrossFailure::kNone;
};

/// Makes the postures of one person complete and plausible, frame by frame. One object per person.
class Reconstructor {
 public:
  virtual ~Reconstructor() = default;
  /// Does not throw for odd observations: all joints missing, NaN, jumps in time.
  virtual ReconstructedPosture Step(const ReconstructionInput& input) = 0;
  /// The previous frame's result as revised by the last Step, for callers that can wait one frame
  /// (files). Empty for methods without revision, and after a gap.
  virtual std::optional<ReconstructedPosture> Revised() const { return std::nullopt; }
  /// Current estimate of the bone lengths, metres; those of the results are updated less often.
  /// Empty for methods that filter joints one by one.
  virtual std::optional<BoneLengths> Bones() const { return std::nullopt; }
  /// Forgets the person.
  virtual void Reset() = 0;
};

class PostureDatabase;  // recon/database/posture_database.h
struct LearnedModels;   // recon/models/learned_models.h
struct PosturePrior;    // recon/models/posture_prior.h

/// Settings of the natural posture space and its energy: shum-2013, plantard-2016.
struct LocalPcaOptions {
  int neighbours = 30;                // K, Shum 2013 table V
  int dimensions = 20;                // of the natural posture space, table V
  int steps = 20;                     // of the local stochastic search, table V
  int samples = 100;                  // per step, table V
  double control = 1.0;               // weight w_c, eq. 15
  double style = 0.5;                 // weight w_s, eq. 15
  double kinematics = 1.5;            // weight w_k, eq. 15
  double continuity = 0.25;           // weight w_m, eq. 15
  std::string solver = "stochastic";  // or "ceres": the same energy by Levenberg-Marquardt
  bool use_reliability = true;        // false: method B of the paper, all seen joints count fully
  bool extend_database = false;       // sec. IX: reliable postures join a private copy at run time
  /// Departure, off by default: joints are interpolated between the posture found and the observed
  /// one by R_i. The papers' result is the posture found, so that gaps in the database move even
  /// joints that were seen well.
  bool keep_reliable = false;
};

/// Settings of the Gaussian-process energy: liu-2016, full-gp.
struct GaussianProcessOptions {
  int nearby_models = 9;     // L, Liu 2016 sec. 4.2.2
  double spatial = 0.6;      // weight w_S, eq. 22
  double temporal = 0.2;     // weight w_T, eq. 22
  double reliability = 0.2;  // weight w_R, eq. 22
  bool incremental = true;   // algorithm 2: reliable samples of low variance join the local models
};

/// Constants of `best` that were tuned on recordings. `ossa experiment sdk` with data = ["nested"]
/// tunes them on other people than those tested.
struct BestConstants {
  // Of the filter; chosen on UI-PRMD: a factor of two in either changes no error by more than
  // 2 %.
  double noise_m = 0.02;       // of one measurement, standard deviation
  double acceleration = 10.0;  // of a joint, m/s^2, standard deviation
  // Chosen on UI-PRMD: share taken of what the learned correction changes with the posture.
  double posture_share = 0.6;
  // Chosen on UI-PRMD, a ratio: weight of a limb's joint over its parent's when bone lengths are
  // enforced.
  double limb_firmness = 0.5;
  // Chosen on UI-PRMD: share of the length expected for a body of this size in a bone's length; the
  // rest is measured.
  double expected_share = 0.3;
  // Chosen on UI-PRMD: distance of a joint from its prediction that is no failure yet.
  double failure_slack_m = 0.12;
};

/// Settings of `best`; the switches are for ablations.
struct BestOptions {
  /// The input is joints after cascaded refinement (recon/refine/refinement_cascade.h): the trunk's
  /// are the most certain, and hidden joints are no longer at the surface that hides
  /// them.
  bool refined_joints = false;
  bool repair = true;    // gross failures are distinguished from motion
  bool complete = true;  // doubtful joints are completed by the posture space
  bool correct = true;   // learned systematic errors are subtracted
  bool window = true;    // ... also by the motion of the last half second, if that was learned
  bool filter = true;    // a filter of each joint, revised a frame later
  bool bones = true;     // constant bone lengths
  BestConstants constants;
};

/// The method, the models it reads, and the settings of each method.
struct ReconstructorOptions {
  std::string method{kDefaultMethod};               // one of ReconstructionMethods()
  std::shared_ptr<const PostureDatabase> database;  // see MethodInfo::database
  std::string learned_file;  // .ossagp of `ossa learn`: liu-2016, full-gp, exemplar, best
  std::shared_ptr<const LearnedModels> learned;  // the same, already in memory; takes precedence
  std::shared_ptr<const PosturePrior> prior;     // used by best instead of the database
  /// Bone lengths measured before, metres, kept from the first frame to the last. Only for methods
  /// that keep bones (MethodInfo).
  std::optional<BoneLengths> bones_m;
  uint64_t seed = 1;  // by hand
  LocalPcaOptions local_pca;
  GaussianProcessOptions gaussian_process;
  BestOptions best;
};

/// Throws InputError for an unknown method, a missing database, missing learned models and
/// impossible bone lengths.
std::unique_ptr<Reconstructor> MakeReconstructor(const ReconstructorOptions& options);

}  // namespace ossa::recon
