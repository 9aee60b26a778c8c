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
#include "tools/tracker/mechanics.h"
#include "tools/tracker/model_set.h"
#include "tools/tracker/scene.h"
#include "tools/tracker/smoothing.h"

namespace ossa::depth {
class FrameSource;
}

/// The run-time tracker: depth frames in, bodies out. Everything the Kinect SDK's skeleton stream
/// gave, for any depth camera. No global state; several trackers may run in one process, each used
/// from one thread at a time.
namespace ossa::tracker {

// Constants: of the Kinect SDK (six people); seed and threads by convention.

/// The SDK's FrameEdges: which image borders cut the body off. Combined by |.
enum ClippedEdge : unsigned {
  kClippedRight = 1,
  kClippedLeft = 2,
  kClippedTop = 4,
  kClippedBottom = 8
};

/// How much is done for a body.
enum class BodyState {
  kPositionOnly,  // known to be there; joints are not looked for
  kTracked,       // fully tracked
};

/// One joint of a tracked body, as an application uses it. Camera space, metres.
struct JointEstimate {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  /// Camera from bone: the bone that ends in this joint has its y axis along the way from the
  /// parent, as the Kinect SDK's absolute orientations. ComputeHierarchicalOrientations gives the
  /// SDK's other kind.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// Tracked: seen in the image. Inferred: guessed from what is seen around it. Not tracked: the
  /// position is what is plausible for the rest of the body.
  recon::TrackingState state = recon::TrackingState::kNotTracked;
  double confidence = 0.0;   // the forest's own trust in what it saw, [0, 1]
  double reliability = 0.0;  // R_i of Shum 2013, eq. 8: does it move and measure as a joint? [0, 1]
};

/// A place where a joint may be, as the forest sees it: a mode of its density estimate.
struct JointProposal {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // camera space, inside the body
  double confidence = 0.0;                               // [0, 1]
  bool seen = true;  // false: no surface of its own voted; inferred from the other joints
};

/// Of every pixel how likely it shows each of the forest's classes: label 0 is the background, 1
/// to 31 are the parts of recon/body/parts.h, of the shipped forest.
struct PartProbabilities {
  int width = 0, height = 0, classes = 0;
  std::vector<float> data;  // height x width x classes, row-major; 0 where nobody is
};

/// One person. `joints` is the skeleton; below it stands what each stage before it made of the
/// person, for who compares or debugs stages. Camera space, metres.
struct Body {
  int id = 0;  // the same from frame to frame for as long as the person is followed, from 1
  BodyState state = BodyState::kTracked;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // middle of the seen surface
  recon::JointArray<JointEstimate> joints;  // as at first where only the position is known
  unsigned clipped_edges = 0;               // of ClippedEdge
  double person_score = 0.0;                // how surely this is a person, [0, 1]

  /// Stage 1, the forest: the joints chosen among its proposals, in this frame alone.
  recon::TrackedPosture raw;
  recon::JointArray<std::vector<JointProposal>> proposals;  // best first; empty unless asked for
  /// Stage 2, the refinement cascade at the depth image, and the pose network where one is used:
  /// the raw joints moved; absent without either.
  std::optional<recon::Posture> refined;
  std::optional<recon::BoneLengths> refined_bones_m;  // as it judges them in this frame alone
  /// Stage 3, the body whose surface explains the depth: with TrackerOptions::fit, where there are
  /// refined joints and the image shows enough of the person.
  std::optional<recon::SurfaceFit> fit;
  /// The person's shape by all fits until now, of which recon::MeasureStature tells their height;
  /// absent before the first.
  std::optional<recon::PersonShape> shape;
  /// Stage 4, the method of reconstruction: made complete, plausible and steady.
  recon::Posture reconstructed;
  std::optional<recon::BoneLengths> bones_m;  // by all frames until now, of methods that keep bones
};

/// Positions of the skeleton, in enum order.
recon::Posture ToPosture(const Body& body);

/// Each bone's turn against its parent's, as the Kinect SDK's hierarchical orientations.
recon::JointOrientations ComputeHierarchicalOrientations(const Body& body);

/// Milliseconds spent on one frame, several people's added up; on several threads `total` is less
/// than the sum. What is spent on things that turn out to be nobody counts with the stages, which
/// way up the camera is, where it is mounted and images that are turned with `segment`.
struct StageTimes {
  double segment = 0, classify = 0, propose = 0, reconstruct = 0, physics = 0, total = 0;
  double fit = 0;  // of the surface, within `reconstruct`
};

/// What the tracker says of one depth frame.
struct BodyFrame {
  int64_t index = 0;
  double time_s = 0.0;
  std::optional<Eigen::Vector4d> floor;   // a b c d, unit normal up: the SDK's floor clip plane
  std::optional<double> tilt_down_rad;    // of the sensor, from the floor; negative: it looks up
  std::vector<Body> bodies;               // by id
  depth::Image<uint8_t> users;            // id of the body each pixel belongs to, 0 nobody
  depth::Image<uint8_t> parts;            // body part per pixel; empty unless asked for
  PartProbabilities probabilities;        // by the trees alone; empty unless asked for
  std::vector<SceneObjectState> objects;  // of TrackerOptions::scene
  people::FrameDecisions decisions;       // why whoever is here was found, or not
  StageTimes ms;
};

/// Which joints are tracked.
enum class TrackingMode {
  kStanding,  // all 20 joints
  kSeated,    // the ten upper joints of the SDK's seated mode; the rest are not tracked
};

/// How far a camera's images must be turned, clockwise, for people to stand upright in them.
enum class Turn {
  kNone,
  kQuarter,
  kHalf,
  kThreeQuarters,
  kAuto,  // as people are seen: where nobody is followed, all four are tried about once a second
};

/// Where the camera is.
enum class Mount {
  kAuto,     // level, until a floor far below and a body on it say that it hangs under the ceiling
  kLevel,    // on a shelf, a table, a tripod: it looks down by less than 45 degrees
  kCeiling,  // 2.2 to 4 m above the floor; it looks down by more than some 55 degrees
};

/// How a Tracker works; as it stands, what the command `ossa track` does without options.
struct TrackerOptions {
  std::string method{recon::kDefaultMethod};  // one of recon::ReconstructionMethods()
  std::optional<ModelSet> models;             // left out: ModelSet::Shipped(method)
  bool physics = false;                       // let the mechanical character follow the posture
  /// Fit the body's surface to the depth image, from the refined joints on, and let the method
  /// start from both. Nothing, or models without a refinement or a surface: no fit.
  std::optional<recon::SurfaceFitOptions> fit = recon::SurfaceFitOptions{};
  MechanicsBuild mechanics;  // how that is built
  /// All people in one mechanical world, with the things of a scene: in place of `physics`, which
  /// knows each person alone. Joints are where that world lets them be.
  std::optional<SceneOptions> scene;
  recon::LocalPcaOptions local_pca;                // of shum-2013 and plantard-2016
  recon::GaussianProcessOptions gaussian_process;  // of liu-2016 and full-gp
  recon::BestOptions best;                         // of best; `refined_joints` follows the models
  /// Left out: what goes with the method (recon::MethodInfo::smoothing). One that is a filter
  /// itself gets no second one, which would only lag.
  std::optional<SmoothingOptions> smoothing;
  TrackingMode mode = TrackingMode::kStanding;
  /// Of TrackWithLag and Run: bodies so many frames later and steadier, 0 (live) to 2.
  int lag = 0;
  /// Of a camera that lies on its side or hangs upside down. All results stay in its own space.
  Turn turn = Turn::kNone;
  Mount mount = Mount::kAuto;  // automatic only with models that have a forest for the ceiling
  /// The SDK's near mode: people from 0.4 to 3 m only, before a level camera.
  bool near_range = false;
  int max_users = 6;
  /// By body id, of people whose bones are known (Body::bones_m of a run before over the same
  /// recording): they stay from the first frame to the last. Only for methods that keep bones.
  std::map<int, recon::BoneLengths> bones_m;
  /// By body id, of people whose shape is known (Body::shape of a run before, or a person file):
  /// whoever gets that id is fitted with it from the first frame on. Ids count who comes into view,
  /// from 1: of several who are there at first the nearest to the camera need not be 1.
  std::map<int, recon::PersonShape> shapes;
  bool keep_parts = false;          // fill BodyFrame::parts
  bool keep_probabilities = false;  // fill BodyFrame::probabilities, and parts
  bool keep_proposals = false;      // fill Body::proposals
  bool trace = false;  // BodyFrame::decisions also names the surfaces that nobody is looked for in
  int threads = 1;
  uint64_t seed = 1;
  void Check() const;  // throws std::invalid_argument with name, value and range
};

/// Follows people from frame to frame. Used from one thread at a time; its own threads are those of
/// TrackerOptions::threads.
class Tracker {
 public:
  /// Loads the shipped models unless the options bring some. Throws InputError naming the file that
  /// is missing or damaged, or what the method needs and the models lack.
  explicit Tracker(const TrackerOptions& options = {});
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// One frame in, its bodies out: polling. Frames of any size, in order of time. Throws InputError
  /// when pixels and camera do not agree in number.
  BodyFrame Track(const depth::DepthFrame& frame);

  /// The same with TrackerOptions::lag: one frame in, the bodies of the frame so many before out,
  /// their joints smoothed by what came after; nothing until so many came.
  std::optional<BodyFrame> TrackWithLag(const depth::DepthFrame& frame);
  /// After TrackWithLag, at the end of a stream: the bodies that are still held, the oldest first;
  /// nothing when all are out.
  std::optional<BodyFrame> DrainLag();

  /// Reads a source to its end, or until the callback returns false. With TrackerOptions::lag the
  /// callback gets bodies late, and at the end those that are still held. `idle` is asked about ten
  /// times a second while no frame comes: false ends the run. Returns how many frames the source
  /// lost. Throws InputError when the source is damaged: DrainLag tells then what is still held.
  int64_t Run(depth::FrameSource& source, const std::function<bool(const BodyFrame&)>& on_bodies,
              const std::function<bool()>& idle = {});

  /// With Turn::kAuto: looks through the beginning of a recording, up to 20 s, for which way up its
  /// camera is, so that its first frames are tracked the right way, too. Follows nobody.
  /// `idle` is asked after every frame: false ends the search.
  void FindUpright(depth::FrameSource& source, const std::function<bool()>& idle = {});
  /// By how many quarters, clockwise, frames are turned now.
  int quarter_turns() const;

  /// Level or under the ceiling, as far as is known now.
  Mount mount() const;

  /// Track only these users fully, the others by position (the SDK's AppChoosesSkeletons).
  void ChooseUsers(std::vector<int> ids);
  void ChooseAllUsers();  // as at the start
  void SetMode(TrackingMode mode);
  /// For a camera that was mounted anew; forgets everybody where it is another turn.
  void SetTurn(Turn turn);
  void SetSmoothing(const SmoothingOptions& smoothing);
  /// The world of TrackerOptions::scene, for an application that has more to do in it; null
  /// without. Until the next frame: with Mount::kAuto it may then be another.
  Scene* scene();
  /// Forgets everybody, frames that a lag holds back (DrainLag tells them before), with
  /// Mount::kAuto where the camera is and with Turn::kAuto which way up; a scene begins anew.
  void Reset();

 private:
  BodyFrame TrackFilled(const depth::DepthFrame& frame);
  BodyFrame TrackAsMounted(const depth::DepthFrame& frame);
  void SwitchToCeiling();

  struct Impl;
  std::unique_ptr<Impl> impl_;
  std::unique_ptr<Impl> level_;  // while impl_ is that of a ceiling: what was before
};

/// "MAJOR.MINOR.PATCH" of the library that runs, which may be another than the headers'.
const char* Version();

/// The SDK's seated joints: shoulders and up, arms and hands.
bool IsSeatedJoint(recon::Joint joint);

}  // namespace ossa::tracker
