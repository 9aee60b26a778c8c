#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"
#include "recon/fit/surface_fit.h"
#include "recon/methods/reconstructor.h"
#include "recon/posture.h"
#include "tools/people/decision.h"
#include "tools/tracker/frame_time_check.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/model_set.h"
#include "tools/tracker/scene.h"
#include "tools/tracker/smoothing.h"

namespace ossa::depth {
class FrameSource;
}

/// The run-time tracker: depth frames in, bodies out. Offers what the Kinect SDK's skeleton stream
/// offered, for any depth camera. No global state; several trackers may run in one process, each
/// used by one thread at a time.
namespace ossa::tracker {

class MountRevision;

// Constants: of the Kinect SDK (six people); seed and threads by convention.

/// The SDK's FrameEdges: which image borders cut the body off. Combined by |.
enum ClippedEdge : unsigned {
  kClippedRight = 1,
  kClippedLeft = 2,
  kClippedTop = 4,
  kClippedBottom = 8
};

/// How much of a body is estimated.
enum class BodyState {
  kPositionOnly,  // position only; no joints are estimated
  kTracked,       // fully tracked
};

/// One joint of a tracked body, as an application uses it. Camera space, metres.
struct JointEstimate {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  /// Camera from bone: the y axis of the bone that ends in this joint points from the parent to the
  /// joint, as in the Kinect SDK's absolute orientations. ComputeHierarchicalOrientations gives the
  /// hierarchical ones.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// Tracked: seen in the image. Inferred: estimated from what is seen around it. Not tracked: only
  /// plausible given the rest of the body.
  recon::TrackingState state = recon::TrackingState::kNotTracked;
  double confidence = 0.0;   // confidence of the forest, [0, 1]
  double reliability = 0.0;  // R_i of Shum 2013, eq. 8: does it move and measure as a joint? [0, 1]
};

/// A joint proposal of the forest: a mode of its density estimate.
struct JointProposal {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space, inside the body
  double confidence = 0.0;                               // [0, 1]
  bool seen = true;  // false: no pixels of this part voted; inferred from the other joints
};

/// The probability of each of the forest's classes for each pixel: label 0 is the background, 1 to
/// 31 are the parts of recon/body/parts.h, for the shipped forest.
struct PartProbabilities {
  int width = 0, height = 0, classes = 0;
  std::vector<float> data;  // height x width x classes, row-major; 0 at pixels of no person
};

/// One person. `joints` is the skeleton; the members below it are the results of the earlier
/// stages, for comparison and debugging. Camera space, metres.
struct Body {
  int id = 0;  // from 1; constant while the person is tracked
  BodyState state = BodyState::kTracked;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // centroid of the visible surface
  recon::JointArray<JointEstimate> joints;               // default values for kPositionOnly
  unsigned clipped_edges = 0;                            // of ClippedEdge
  double person_score = 0.0;                             // probability of being a person, [0, 1]

  /// Stage 1, the forest: the joints chosen among its proposals, in this frame alone.
  recon::TrackedPosture raw;
  recon::JointArray<std::vector<JointProposal>> proposals;  // best first; empty unless asked for
  /// Stage 2, the refinement cascade at the depth image, and the pose network where one is used:
  /// the raw joints moved; absent without either.
  std::optional<recon::Posture> refined;
  std::optional<recon::BoneLengths> refined_bones_m;  // its estimate in this frame alone
  /// Stage 3, the fitted body surface: with TrackerOptions::fit, if there are refined joints and
  /// enough of the person is visible.
  std::optional<recon::SurfaceFit> fit;
  /// The person's mean shape over all fits, from which recon::MeasureStature computes their height;
  /// absent before the first fit.
  std::optional<recon::PersonShape> shape;
  /// Stage 4, the reconstruction method: complete, plausible and steady.
  recon::Posture reconstructed;
  std::optional<recon::BoneLengths>
      bones_m;  // mean over the frames, for methods that keep bone lengths
};

/// Positions of the skeleton, in enum order.
recon::Posture ToPosture(const Body& body);

/// Each bone's rotation relative to its parent, as the Kinect SDK's hierarchical orientations.
recon::JointOrientations ComputeHierarchicalOrientations(const Body& body);

/// Processing times of one frame, milliseconds, summed over people; with several threads `total` is
/// less than the sum. Rejected candidates count in the stages; searching for image rotation and
/// mount, and rotating images, counts in `segment`.
struct StageTimes {
  double segment = 0, classify = 0, propose = 0, reconstruct = 0, physics = 0, total = 0;
  double fit = 0;  // of the surface fit, part of `reconstruct`
};

/// The result of one depth frame.
struct BodyFrame {
  int64_t index = 0;
  double time_s = 0.0;
  std::optional<Eigen::Vector4d> floor;   // a b c d, unit normal up: the SDK's floor clip plane
  std::optional<double> tilt_down_rad;    // of the sensor, from the floor; negative: it looks up
  std::vector<Body> bodies;               // by id
  depth::Image<uint8_t> users;            // id of the body each pixel belongs to, 0 for none
  depth::Image<uint8_t> parts;            // body part per pixel; empty unless asked for
  PartProbabilities probabilities;        // by the trees alone; empty unless asked for
  std::vector<SceneObjectState> objects;  // of TrackerOptions::scene
  people::FrameDecisions decisions;       // why each candidate was accepted or rejected
  StageTimes ms;
};

/// Which joints are tracked.
enum class TrackingMode {
  kStanding,  // all 20 joints
  kSeated,    // the ten upper joints of the SDK's seated mode; the rest are not tracked
};

/// The clockwise rotation of a camera's images after which people stand upright in them.
enum class Turn {
  kNone,
  kQuarter,
  kHalf,
  kThreeQuarters,
  kAuto,  // by the people in view: while none is tracked, all four are tried about once a second
};

/// The mount of the camera.
enum class Mount {
  kAuto,     // level, until a floor far below with a body on it shows a camera under the ceiling
  kLevel,    // on a shelf, a table, a tripod: tilted down by less than 45 degrees
  kCeiling,  // 2.2 to 4 m above the floor: tilted down by more than about 55 degrees
};

/// Options of a Tracker; the defaults are those of the command `ossa track`.
struct TrackerOptions {
  std::string method{recon::kDefaultMethod};  // one of recon::ReconstructionMethods()
  std::optional<ModelSet> models;             // left out: ModelSet::Shipped(method)
  bool physics = false;  // simulate a mechanical character that follows the posture
  /// Fit the body's surface to the depth image, starting from the refined joints, and pass both to
  /// the method. Without a value, or with models that lack a refinement or a surface: no fit.
  std::optional<recon::SurfaceFitOptions> fit = recon::SurfaceFitOptions{};
  MechanicsBuild mechanics;  // how the character is built
  /// Simulate all people in one mechanical world with the objects of a scene, in place of
  /// `physics`, which simulates each person alone. The result obeys that world.
  std::optional<SceneOptions> scene;
  recon::LocalPcaOptions local_pca;                // of shum-2013 and plantard-2016
  recon::GaussianProcessOptions gaussian_process;  // of liu-2016 and full-gp
  recon::BestOptions best;                         // of best; `refined_joints` follows the models
  /// Default: the smoothing of the method (recon::MethodInfo::smoothing). Methods that filter have
  /// none, because a second filter only adds lag.
  std::optional<SmoothingOptions> smoothing;
  TrackingMode mode = TrackingMode::kStanding;
  /// For TrackWithLag and Run: delay in frames, 0 (live) to 2, for smoother bodies.
  int lag = 0;
  /// For a camera on its side or upside down. All results stay in its own space.
  Turn turn = Turn::kNone;
  Mount mount = Mount::kAuto;  // automatic only with models that have a forest for the ceiling
  /// The SDK's near mode: people from 0.4 to 3 m only, before a level camera.
  bool near_range = false;
  int max_users = 6;
  /// Known bone lengths by body id (Body::bones_m of an earlier run over the same recording), which
  /// are kept for the whole run. Only for methods that keep bones.
  std::map<int, recon::BoneLengths> bones_m;
  /// Known shapes by body id (Body::shape of an earlier run, or a person file): the person who gets
  /// that id is fitted with it from the first frame. Ids are given from 1 in the order of
  /// appearance; of several people in the first frame the nearest need not be 1.
  std::map<int, recon::PersonShape> shapes;
  bool keep_parts = false;          // fill BodyFrame::parts
  bool keep_probabilities = false;  // fill BodyFrame::probabilities, and parts
  bool keep_proposals = false;      // fill Body::proposals
  bool trace = false;  // BodyFrame::decisions also lists the surfaces excluded from the search
  int threads = 1;
  uint64_t seed = 1;
  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// Tracks people over frames. Used by one thread at a time; its own threads are
/// TrackerOptions::threads.
class Tracker {
 public:
  /// Loads the shipped models unless the options bring some. Throws InputError naming the file that
  /// is missing or damaged, or what the method needs and the models lack.
  explicit Tracker(const TrackerOptions& options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// Tracks one frame. Frames may differ in size and come in order of time. Throws InputError if
  /// the number of pixels does not match the camera.
  BodyFrame Track(const depth::DepthFrame& frame);

  /// With TrackerOptions::lag: takes one frame and returns the bodies of the frame `lag` frames
  /// earlier, smoothed over the frames before and after; nothing for the first `lag` frames.
  std::optional<BodyFrame> TrackWithLag(const depth::DepthFrame& frame);
  /// At the end of a stream, after TrackWithLag: the next held frame, oldest first; nothing when
  /// all were returned.
  std::optional<BodyFrame> DrainLag();

  /// Tracks a source to its end, or until the callback returns false. With TrackerOptions::lag
  /// bodies are delayed, and the held ones are passed at the end. `idle` is called about ten times
  /// a second while no frame arrives; false ends the run. Returns the number of frames that the
  /// source dropped. Throws InputError if the source is damaged; DrainLag then returns the held
  /// frames.
  int64_t Run(depth::FrameSource& source, const std::function<bool(const BodyFrame&)>& on_bodies,
              const std::function<bool()>& idle = {});

  /// With Turn::kAuto: searches the beginning of a recording, up to 20 s, for the image rotation,
  /// so that its first frames are tracked upright, too. Tracks no people. `idle` is called after
  /// every frame; false ends the search.
  void FindUpright(depth::FrameSource& source, const std::function<bool()>& idle = {});
  /// The current clockwise rotation of frames, in quarter turns.
  int quarter_turns() const;

  /// The current mount, level or under the ceiling. Mount::kAuto may take a wrong decision for the
  /// ceiling back within seconds.
  Mount mount() const;

  /// Track only these users fully, the others by position (the SDK's AppChoosesSkeletons).
  void ChooseUsers(std::vector<int> ids);
  void ChooseAllUsers();  // the default
  void SetMode(TrackingMode mode);
  /// For a camera that was rotated; a changed turn deletes all tracks.
  void SetTurn(Turn turn);
  void SetSmoothing(const SmoothingOptions& smoothing);
  /// The scene of TrackerOptions::scene; null without. Valid until the next frame: with
  /// Mount::kAuto the tracker may be replaced then.
  Scene* scene();
  /// A line for the user if the times of the first frames cannot be seconds, or if people move so
  /// fast by them that the frame rate must be wrong; each once.
  std::optional<std::string> TakeWarning();
  /// Deletes all tracks, the frames held by the lag (call DrainLag before), the found mount of
  /// Mount::kAuto and the found rotation of Turn::kAuto; restarts the scene.
  void Reset();

 private:
  BodyFrame TrackFilled(const depth::DepthFrame& frame);
  BodyFrame TrackAsMounted(const depth::DepthFrame& frame);
  BodyFrame ReconsiderMount(const depth::DepthFrame& frame, BodyFrame from_above);
  void SwitchToCeiling();
  void SwitchToLevel();

  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::unique_ptr<Impl>
      level_;  // while impl_ is the tracker for the ceiling: the one for a level camera
  std::unique_ptr<MountRevision> revision_;  // while the decision for the ceiling is reconsidered
  FrameTimeCheck times_;
};

/// "MAJOR.MINOR.PATCH" of the loaded library, which may differ from the headers'.
const char* Version();

/// The SDK's seated joints: shoulders and up, arms and hands.
bool IsSeatedJoint(recon::Joint joint);

}  // namespace ossa::tracker
