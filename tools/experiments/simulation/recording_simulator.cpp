#include "tools/experiments/simulation/recording_simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "depth/base/error.h"
#include "depth/render/shapes.h"
#include "recon/body/body_model.h"
#include "recon/body/clothing.h"
#include "recon/fit/body_surface.h"
#include "recon/refine/pose_network.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/experiments/compare/sequence_text.h"
#include "tools/experiments/context_models.h"
#include "tools/experiments/simulation/recording_simulator_internal.h"
#include "tools/synth/clothed_body.h"
#include "tools/synth/dataset.h"
#include "tools/synth/props.h"
#include "tools/synth/sample_person.h"
#include "tools/synth/sequence_poses.h"
#include "tools/synth/visibility_internal.h"
#include "tools/tracker/shipped.h"
#include "tools/tracker/skeleton_record.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {
namespace {

// Constants: of the scenes that are played, by hand.

constexpr double kSensorHeight_m = 1.0;

Eigen::Isometry3d CameraPlace(const SequenceOptions& options) {
  const Eigen::Vector3d eye(options.distance_m * std::sin(options.azimuth_rad), kSensorHeight_m,
                            options.distance_m * std::cos(options.azimuth_rad));
  return LookAt(eye, {0, 0.9, 0});
}

// A seat with its backrest towards the sensor, half a metre in front of the person: it hides the
// legs and, seen from the side, an arm.
depth::TriangleMesh CarSeat() {
  depth::TriangleMesh seat = depth::MakeSofa(0.62f, 0.60f, 0.45f);
  Eigen::Affine3f place = Eigen::Affine3f::Identity();
  place.translate(Eigen::Vector3f(0.05f, 0.35f, 0.62f));
  depth::TriangleMesh raised = depth::Moved(seat, place);
  Eigen::Affine3f under = Eigen::Affine3f::Identity();
  under.translate(Eigen::Vector3f(0.05f, 0.175f, 0.62f));
  depth::Append(raised, depth::Moved(depth::MakeBox({0.5f, 0.35f, 0.5f}), under));
  return raised;
}

depth::TriangleMesh RoomAround() {
  depth::TriangleMesh room = depth::MakeRoom({7.0f, 3.0f, 8.0f});
  return depth::Moved(room, Eigen::Affine3f::Identity());
}

}  // namespace

struct RecordingSimulator::State {
  explicit State(const ExperimentContext& given, std::string how)
      : context(given), observer(std::move(how)) {}

  const ExperimentContext& context;
  std::string observer;
  ObserverFiles files;
  std::unique_ptr<recon::BodyModel> model;
  std::unique_ptr<recon::Wardrobe> wardrobe;

  void LoadBodyOnce() {
    if (model) return;
    model = std::make_unique<recon::BodyModel>(LoadFetchedBody());
    wardrobe = std::make_unique<recon::Wardrobe>(*model);
  }
};

namespace {

// One sequence being rendered.
class SequenceRenderer {
 public:
  SequenceRenderer(const recon::BodyModel& model, const recon::Wardrobe& wardrobe,
                   const recon::MotionClip& clip, const SequenceOptions& options)
      : model_(model),
        options_(options),
        camera_(depth::KinectV1Camera(options.width, options.height)),
        camera_from_world_(CameraPlace(options)),
        poses_(SequencePoses({clip}, options.frames, options.seed)) {
    Random random(options.seed, 1);
    const recon::BodyShape shape = SampleShape(Split::kTest, random);
    bodies_.emplace_back(model, wardrobe, shape, SampleClothing(random));
    bodies_[0].AddTo(renderer_);
    const Eigen::Affine3f to_camera(camera_from_world_.matrix().cast<float>());
    renderer_.AddMesh(depth::Moved(RoomAround(), to_camera), false);
    if (options.clutter == Clutter::kCarSeat) {
      renderer_.AddMesh(depth::Moved(CarSeat(), to_camera), false);
    }
    if (options.clutter == Clutter::kFurniture) {
      for (const Prop& prop : Props(Occluders::kScene)) renderer_.AddMesh(prop.mesh_in_cam, false);
    }
    if (options.clutter == Clutter::kHeld) held_ = Props(Occluders::kHeld);
  }

  size_t size() const { return poses_.size(); }
  SequenceFrame RenderFrame(size_t index);

 private:
  std::vector<Prop> Props(Occluders kind) const;
  LabelledFrame RenderDepth(size_t index, const recon::Posture& joints);

  const recon::BodyModel& model_;
  SequenceOptions options_;
  depth::Camera camera_;
  Eigen::Isometry3d camera_from_world_;
  std::vector<recon::RigPose> poses_;
  std::vector<ClothedBody> bodies_;  // one
  depth::Renderer renderer_;
  std::vector<Prop> held_;  // as in the first posture
};

// Objects between the person's whole path and the sensor, or held in the first posture.
std::vector<Prop> SequenceRenderer::Props(Occluders kind) const {
  if (poses_.empty()) return {};
  std::vector<recon::Posture> path_in_world;
  for (const recon::RigPose& pose : poses_)
    path_in_world.push_back(recon::ComputeJoints(bodies_[0].shape(), pose));
  Random random(options_.seed, 2);
  return SampleLastingProps(kind, path_in_world, camera_from_world_, random);
}

LabelledFrame SequenceRenderer::RenderDepth(size_t index, const recon::Posture& joints) {
  std::vector<int> held;
  if (!held_.empty()) {
    recon::Posture first = recon::ComputeJoints(bodies_[0].shape(), poses_[0]);
    for (auto& joint_m : first.position_m) joint_m = camera_from_world_ * joint_m;
    for (const Prop& prop : held_)
      held.push_back(renderer_.AddMesh(Carried(prop, first, joints).mesh_in_cam, false));
  }
  LabelledFrame frame =
      RenderBodies(renderer_, camera_, model_, bodies_, options_.seed * 1000003 + index);
  for (const int mesh : held) renderer_.RemoveMesh(mesh);
  frame.depth.index = static_cast<int64_t>(index);
  frame.depth.time_s = static_cast<double>(index) / 30.0;
  frame.bodies.push_back({1, joints, {}});
  MarkVisibleJoints(&frame);
  return frame;
}

SequenceFrame SequenceRenderer::RenderFrame(size_t index) {
  const recon::Posture joints = bodies_[0].Pose(poses_[index], camera_from_world_);
  bodies_[0].UpdateMesh(renderer_);
  LabelledFrame labelled = RenderDepth(index, joints);
  SequenceFrame frame;
  frame.truth.frame = labelled.depth.index;
  frame.truth.time_s = labelled.depth.time_s;
  const Eigen::Vector3d up = camera_from_world_.linear().col(1);
  frame.truth.floor =
      Eigen::Vector4d(up.x(), up.y(), up.z(), -up.dot(camera_from_world_.translation()));
  recon::BodyRecord body;
  body.id = 1;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    recon::JointRecord joint;
    joint.position_m = joints.position_m[j];
    joint.visible = labelled.bodies[0].visible[j];
    body.joints[j] = joint;
  }
  frame.truth.bodies.push_back(body);
  frame.depth = std::move(labelled.depth);
  return frame;
}

// The tracker's body nearest to the true one. If there is none, a body without joints, so that
// methods must bridge the frame.
recon::SkeletonFrame FindNearestBody(const recon::SkeletonFrame& tracked,
                                     const recon::SkeletonFrame& truth) {
  constexpr double kReach_m = 0.6;
  recon::SkeletonFrame person = truth;
  person.bodies.assign(1, {});
  double nearest_m = kReach_m;
  for (const recon::BodyRecord& body : tracked.bodies) {
    double sum_m = 0;
    double count = 0;
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!body.joints[j]) continue;
      sum_m += (body.joints[j]->position_m - truth.bodies[0].joints[j]->position_m).norm();
      ++count;
    }
    if (count == 0 || sum_m / count >= nearest_m) continue;
    nearest_m = sum_m / count;
    person.bodies[0] = body;
  }
  person.bodies[0].id = 1;
  return person;
}

}  // namespace

std::vector<std::filesystem::path> ObserverFiles::All() const {
  std::vector<std::filesystem::path> all;
  for (const auto& path : {forest, refinement, network, surface}) {
    if (!path.empty()) all.push_back(path);
  }
  return all;
}

ObserverFiles FindObserverFiles(const std::filesystem::path& model) {
  ObserverFiles files;
  files.surface = tracker::ShippedFile(recon::kShippedSurface);
  files.forest = model;
  if (!model.empty()) return files;
  files.forest = tracker::ShippedFile("body.ossa");
  files.refinement = tracker::ShippedFile(recon::kShippedRefinement);
  files.network = tracker::ShippedFile(recon::kShippedPoseNetwork);
  return files;
}

void BeginWhenFound(RecordedPair& pair) {
  constexpr auto kEnough = recon::kJointCount / 2;
  const auto found = [](const recon::SkeletonFrame& frame) {
    const auto& joints = frame.bodies.at(0).joints;
    const auto seen = std::count_if(joints.begin(), joints.end(),
                                    [](const auto& joint) { return joint.has_value(); });
    return seen >= kEnough;
  };
  const auto& observed = pair.observed.frames;
  const auto before = std::find_if(observed.begin(), observed.end(), found) - observed.begin();
  for (recon::SkeletonSequence* sequence : {&pair.observed, &pair.refined, &pair.truth}) {
    auto& frames = sequence->frames;
    const auto dropped = std::min(before, std::ssize(frames));
    frames.erase(frames.begin(), frames.begin() + dropped);
  }
}

namespace {

std::string ComputeKey(const SequenceOptions& o) {
  return fmt::format("{} {} {:.4f} {:.3f} {}x{} {} seed {}", o.name, static_cast<int>(o.clutter),
                     o.azimuth_rad, o.distance_m, o.width, o.height, o.frames, o.seed);
}

std::string ComputeKey(const recon::MotionClip& clip) {
  double sum = 0;
  for (const auto& pose : clip.frames) sum += pose.root_m.sum() + pose.world_from_rest[19].x();
  return fmt::format("{} {} {:.9g}", clip.name, clip.frames.size(), sum);
}

}  // namespace

RecordingSimulator::RecordingSimulator(const ExperimentContext& context, std::string observer)
    : state_(std::make_unique<State>(context, std::move(observer))) {
  if (state_->observer == "forest") {
    state_->files = FindObserverFiles(context.model);
  } else if (state_->observer != "simulated") {
    throw InputError("observer '" + state_->observer + "': expected forest or simulated");
  }
}
RecordingSimulator::~RecordingSimulator() = default;

std::vector<SequenceFrame> RecordingSimulator::RenderClip(const recon::MotionClip& clip,
                                                          const SequenceOptions& options) {
  state_->LoadBodyOnce();
  SequenceRenderer renderer(*state_->model, *state_->wardrobe, clip, options);
  std::vector<SequenceFrame> frames;
  for (size_t f = 0; f < renderer.size(); ++f) frames.push_back(renderer.RenderFrame(f));
  return frames;
}

namespace {

// Joints of the forest and its refinement, before any reconstruction.
tracker::Tracker MakeObserver(const ExperimentContext& context, const ObserverFiles& observer) {
  tracker::TrackerOptions options;
  options.method = "none";
  tracker::ModelFiles files;
  files.forest = observer.forest.string();
  files.refinement = observer.refinement.string();
  options.models = LoadModels(context, files, options.method);
  options.smoothing = tracker::SmoothingPreset("none");
  options.threads = context.threads;
  return tracker::Tracker(options);
}

// A cached recording is the concatenated text of its three sequences.
std::string FormatRecording(const RecordedPair& pair) {
  std::string text =
      FormatSequence(pair.observed).append(kSequenceEnd).append(FormatSequence(pair.refined));
  return text.append(kSequenceEnd).append(FormatSequence(pair.truth));
}

RecordedPair ParseRecording(const std::string& text, const std::string& name) {
  const size_t end = text.find(kSequenceEnd), refined = end + kSequenceEnd.size();
  const size_t refined_end = text.find(kSequenceEnd, refined);
  RecordedPair pair;
  pair.observed = ParseSequence(text.substr(0, end), name);
  if (refined_end > refined) {
    pair.refined = ParseSequence(text.substr(refined, refined_end - refined), name);
  }
  pair.truth = ParseSequence(text.substr(refined_end + kSequenceEnd.size()), name);
  return pair;
}

}  // namespace

RecordedPair RecordingSimulator::Observe(const recon::MotionClip& clip,
                                         const SequenceOptions& options) {
  state_->LoadBodyOnce();
  SequenceRenderer renderer(*state_->model, *state_->wardrobe, clip, options);
  std::optional<tracker::Tracker> tracker;
  if (state_->observer == "forest") tracker.emplace(MakeObserver(state_->context, state_->files));
  SimulatedSdk sdk(options.seed);
  RecordedPair pair;
  for (size_t f = 0; f < renderer.size(); ++f) {
    state_->context.ThrowIfInterrupted();
    const SequenceFrame frame = renderer.RenderFrame(f);
    pair.truth.frames.push_back(frame.truth);
    if (!tracker) {
      pair.observed.frames.push_back(sdk.Observe(frame));
      continue;
    }
    const tracker::BodyFrame bodies = tracker->Track(frame.depth);
    const auto person = [&](tracker::PostureKind kind) {
      return FindNearestBody(tracker::ToRecord(bodies, kind), frame.truth);
    };
    pair.observed.frames.push_back(person(tracker::PostureKind::kRaw));
    if (state_->files.refinement.empty()) continue;
    pair.refined.frames.push_back(person(tracker::PostureKind::kRefined));
  }
  return pair;
}

RecordedPair RecordingSimulator::Record(const recon::MotionClip& clip,
                                        const SequenceOptions& options) {
  std::string key = fmt::format("staged {} {} {} {}", ComputeCodeKey(), state_->observer,
                                ComputeKey(options), ComputeKey(clip));
  for (const auto& path : state_->files.All()) key.append(" ").append(ComputeFileKey(path));
  const std::string text =
      state_->context.Cached(key, [&] { return FormatRecording(Observe(clip, options)); });
  RecordedPair pair = ParseRecording(text, options.name);
  pair.clip = options.name;
  pair.subject = clip.subject.empty() ? clip.name : clip.subject;
  BeginWhenFound(pair);
  return pair;
}

std::string ReadObserver(Parameters& parameters) {
  return parameters.OneOf("observer", {"forest", "simulated"}, "forest");
}

std::string ObserverNote(const std::string& observer) {
  return observer == "forest"
             ? "Observed by ossa's own forest on rendered depth images (MPFB bodies of test "
               "shapes, Embree, structured-light noise), not by the Kinect SDK. "
             : "Observed by a simulation of the Kinect SDK's failures on rendered depth images "
               "(MPFB bodies of test shapes, Embree), not by the SDK. ";
}

}  // namespace ossa::tools
