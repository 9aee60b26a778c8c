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

/// What a method gets of one person at one time.
struct ReconstructionInput {
  TrackedPosture observed;  // camera space
  double time_s = 0.0;      // steps may be irregular; gaps of seconds happen
  /// The depth image, when there is one: whether a surface lies where a joint is said to be tells
  /// an occluded joint from a wrong one. Borrowed for the call.
  const depth::DepthFrame* depth = nullptr;
  /// The person's bones as cascaded refinement estimates them in this frame
  /// (recon/refine/bone_estimation.h).
  std::optional<BoneLengths> bones_m = std::nullopt;
  /// a b c d of ax + by + cz + d = 0, unit normal up, camera space: which way is up. Without one,
  /// somebody who stands tells.
  std::optional<Eigen::Vector4d> floor = std::nullopt;
  /// Takes the observed joints to the space of the depth image, where they are in another.
  std::optional<Eigen::Isometry3d> camera_from_observed = std::nullopt;
};

/// What a method may find wrong with all that was observed of a person.
enum class GrossFailure {
  kNone,
  kSidesExchanged,  // left is right: the posture has it the right way round
  kAnotherBody,     // no body moves so: nothing of it is in the posture
};

/// What a method makes of one person at one time.
struct ReconstructedPosture {
  Posture posture;                   // camera space, all 20 joints finite
  JointArray<double> reliability{};  // R_i in [0, 1] of the observed joint, eq. 8
  /// Camera from bone (recon/orientation.h), of methods that know how bones are turned about
  /// themselves, from a database; else empty: what joints tell of it, ComputeOrientations says.
  std::optional<JointOrientations> orientation = std::nullopt;
  GrossFailure failure = GrossFailure::kNone;
};

/// One person's posture made complete and plausible, frame by frame. One object per person.
class Reconstructor {
 public:
  virtual ~Reconstructor() = default;
  /// Never throws on odd observations: all joints missing, NaN, jumps in time.
  virtual ReconstructedPosture Step(const ReconstructionInput& input) = 0;
  /// What the last Step made the method think of the frame before it, for callers that can wait one
  /// frame (files). Empty for methods that do not look back, and after a gap.
  virtual std::optional<ReconstructedPosture> Revised() const { return std::nullopt; }
  /// How long the person's bones are, by all that was observed until now: those of what comes out
  /// change more rarely. Empty for methods that move joints alone.
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
  bool use_reliability = true;        // false: the paper's method B, every joint seen counts fully
  bool extend_database = false;       // sec. IX: reliable postures join a private copy at run time
  /// Departure, off by default: each joint ends between the posture found and where it was seen,
  /// by R_i. The papers show the posture found alone, so that what the database lacks moves even
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

/// What of `best` was chosen on recordings. `ossa experiment sdk` with data = ["nested"] chooses
/// each on people other than those it is then tested on.
struct BestConstants {
  // Of the filter; chosen on UI-PRMD: within a factor of two of each nothing moves by more than 2
  // %.
  double noise_m = 0.02;       // of one measurement, standard deviation
  double acceleration = 10.0;  // of a joint, m/s^2, standard deviation
  // Chosen on UI-PRMD: share taken of what the learned correction changes with the posture.
  double posture_share = 0.6;
  // Chosen on UI-PRMD, a ratio: how firm a joint of a limb is, over its parent, when bones get
  // their lengths.
  double limb_firmness = 0.5;
  // Chosen on UI-PRMD: share of what is expected of a body of this size in a bone's length, beside
  // what is measured.
  double expected_share = 0.3;
  // Chosen on UI-PRMD: a joint may be so far from where it was expected without having failed.
  double failure_slack_m = 0.12;
};

/// Settings of `best`; the switches are for ablations.
struct BestOptions {
  /// What is observed are joints after cascaded refinement (recon/refine/refinement_cascade.h): the
  /// trunk's are the surest, and those of hidden joints are no longer where the surface is that
  /// hides them.
  bool refined_joints = false;
  bool repair = true;    // gross failures are distinguished from motion
  bool complete = true;  // joints in doubt come from the posture space
  bool correct = true;   // learned systematic errors are taken off
  bool window = true;    // ... by what the person did before, too, where that was learned
  bool filter = true;    // of each joint, revised a frame later
  bool bones = true;     // constant bone lengths
  BestConstants constants;
};

/// Which method, what it reads, and the settings of each.
struct ReconstructorOptions {
  std::string method{kDefaultMethod};               // one of ReconstructionMethods()
  std::shared_ptr<const PostureDatabase> database;  // needed by the methods that look things up
  std::string learned_file;  // .ossagp of `ossa learn`: liu-2016, full-gp, exemplar, best
  std::shared_ptr<const LearnedModels> learned;  // the same, already in memory; goes first
  std::shared_ptr<const PosturePrior> prior;     // best completes by it, else by the database
  /// The person's bones, where they were measured before: they stay from the first frame to the
  /// last. Only for methods that keep bones (MethodInfo).
  std::optional<BoneLengths> bones_m;
  uint64_t seed = 1;  // by hand
  LocalPcaOptions local_pca;
  GaussianProcessOptions gaussian_process;
  BestOptions best;
};

/// Throws InputError for an unknown method, a missing database, missing learned models and bones
/// that cannot be.
std::unique_ptr<Reconstructor> MakeReconstructor(const ReconstructorOptions& options);

}  // namespace ossa::recon
