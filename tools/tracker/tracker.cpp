#include "tools/tracker/tracker.h"

#include <chrono>
#include <map>
#include <stdexcept>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/stopwatch.h"
#include "depth/image/hole_filling.h"
#include "depth/sensor/frame_source.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/tracker/frame_parts_internal.h"
#include "tools/tracker/tracker_internal.h"

namespace ossa::tracker {
namespace {

std::map<int, Eigen::Vector3d> PositionsOf(const std::vector<Body>& bodies) {
  std::map<int, Eigen::Vector3d> positions_m;
  for (const Body& body : bodies) positions_m[body.id] = body.position_m;
  return positions_m;
}

SmoothingOptions ResolveSmoothing(const TrackerOptions& options) {
  if (options.smoothing) return *options.smoothing;
  return SmoothingPreset(recon::RequireMethod(options.method).smoothing);
}

recon::ReconstructorOptions MethodOptions(const TrackerOptions& options, const ModelSet& models) {
  recon::ReconstructorOptions method;
  method.method = options.method;
  method.database = models.database;
  method.prior = models.prior;
  method.learned = models.learned;
  method.learned_file = models.learned_file;  // for messages
  method.local_pca = options.local_pca;
  method.gaussian_process = options.gaussian_process;
  method.best = options.best;
  method.best.refined_joints = models.refinement != nullptr;
  method.seed = options.seed;
  return method;
}

bool IsFromAbove(Mount mount, const ModelSet& models) {
  return mount == Mount::kCeiling || (mount == Mount::kAuto && models.from_ceiling);
}

// A refinement learned for the other mount would give wrong joints without an error.
void CheckRefinement(const ModelSet& models, bool from_above) {
  if (!models.refinement || models.refinement->from_above() == from_above) return;
  const std::string name = models.refinement_file.empty() ? "refinement" : models.refinement_file;
  throw InputError(
      name + (from_above ? ": expected a refinement learned on people seen from the ceiling, found "
                           "one for level cameras"
                         : ": expected a refinement learned on people before a level camera, found "
                           "one for cameras under the ceiling (--mount ceiling)"));
}

ModelSet LoadModels(const TrackerOptions& options) {
  ModelSet models = options.models ? *options.models : ModelSet::Shipped(options.method);
  const bool exchanged = options.mount == Mount::kCeiling && !models.ceiling_file.empty();
  if (exchanged) models = LoadCeilingModels(models, LoadCeilingForest(models));
  const bool from_above = IsFromAbove(options.mount, models);
  if (models.from_ceiling && !from_above) models.refinement = nullptr;  // declared level
  CheckRefinement(models, from_above);
  return models;
}

const forest::ForestModel& RequireForest(const ModelSet& models) {
  if (models.forest) return *models.forest;
  throw std::invalid_argument("TrackerOptions.models.forest = null, must be a forest");
}

}  // namespace

Tracker::Impl::Impl(const TrackerOptions& o)
    : options(o),
      models(LoadModels(o)),
      model(RequireForest(models)),
      targets(people::FindJointTargets(model, models.forest_file)),
      lagged(NothingLagged()) {
  skeleton.forest = &model;
  skeleton.targets = targets;
  skeleton.refinement = models.refinement.get();
  if (!IsUnderCeiling()) skeleton.pose_network = models.pose_network.get();
  skeleton.surface = models.surface.get();
  if (models.surface && (models.refinement || IsUnderCeiling())) skeleton.fit = o.fit;
  skeleton.from_above = IsUnderCeiling();
  skeleton.mode = o.mode;
  if (o.scene) scene.emplace(*o.scene);
  skeleton.scene = scene.has_value();
  skeleton.physics = o.physics && !skeleton.scene;
  skeleton.mechanics = o.mechanics;
  skeleton.smoothing = ResolveSmoothing(o);
  skeleton.bones_m = o.bones_m;
  skeleton.reconstructor = MethodOptions(o, models);
  recon::MakeReconstructor(skeleton.reconstructor);  // reports wrong options now
  for (const auto& [id, lengths_m] : o.bones_m) MethodFor(id, skeleton);
  if (IsUnderCeiling()) people_options = people::PeopleOptionsFromAbove();
  // Under the ceiling people are near, but the floor is needed and farther.
  people_options.scene.max_depth_m = o.near_range && !IsUnderCeiling() ? 3.0F : 6.0F;
  people_options.initiation.max_users = o.max_users;
  people_options.threads = o.threads;
  people_options.trace_surfaces = o.trace;
}

bool Tracker::Impl::IsUnderCeiling() const { return IsFromAbove(options.mount, models); }

LaggedBodies Tracker::Impl::NothingLagged() const {
  return LaggedBodies(
      recon::LagOptions::Of(options.lag, recon::RequireMethod(options.method).keeps_bones));
}

void Tracker::Impl::CopySettings(const Impl& other) {
  chosen_ids = other.chosen_ids;
  skeleton.mode = other.skeleton.mode;
  skeleton.smoothing = other.skeleton.smoothing;
  if (options.turn != other.options.turn) upright = {};
  options.turn = other.options.turn;
}

void TrackerOptions::Check() const {
  if (max_users < 1 || max_users > 6) {
    throw std::invalid_argument("TrackerOptions.max_users = " + std::to_string(max_users) +
                                ", must be in [1, 6]");
  }
  if (threads < 1 || threads > 256) {
    throw std::invalid_argument("TrackerOptions.threads = " + std::to_string(threads) +
                                ", must be in [1, 256]");
  }
  if (lag < 0 || lag > 2) {
    throw std::invalid_argument("TrackerOptions.lag = " + std::to_string(lag) +
                                ", must be in [0, 2]");
  }
  if (smoothing) smoothing->Check();
  if (scene) scene->Check();
  if (fit) fit->Check();
}

Tracker::Tracker(const TrackerOptions& options) {
  options.Check();
  impl_ = std::make_unique<Impl>(options);
}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

// The frame's time includes hole filling and mount detection.
BodyFrame Tracker::TrackFilled(const depth::DepthFrame& frame) {
  const Stopwatch watch;
  CheckFrame(frame);
  times_.Add(frame.time_s);
  const auto filled = depth::FillScatteredHoles(frame);
  BodyFrame result = TrackAsMounted(filled ? *filled : frame);
  if (filled) ClearHoles(frame.view(), result);
  times_.AddPeople(PositionsOf(result.bodies));
  const double total = watch.milliseconds();
  result.ms.segment += total - result.ms.total;
  result.ms.total = total;
  return result;
}

// Tracks in the camera's own space; switches to the ceiling models once the frame shows that view.
BodyFrame Tracker::TrackAsMounted(const depth::DepthFrame& frame) {
  BodyFrame result = impl_->TrackTurned(frame);
  if (revision_ && revision_->IsDue(frame.time_s)) {
    return ReconsiderMount(frame, std::move(result));
  }
  if (!impl_->ShowsCeilingView(frame, result)) return result;
  SwitchToCeiling();
  revision_ = std::make_unique<MountRevision>(frame.time_s);
  return impl_->TrackTurned(frame);
}

// Returns what the models of the mount that is decided on now found in the frame.
BodyFrame Tracker::ReconsiderMount(const depth::DepthFrame& frame, BodyFrame from_above) {
  level_->CopySettings(*impl_);
  level_->DeleteTracks();
  BodyFrame level = level_->TrackTurned(frame);
  switch (revision_->Add(level, from_above)) {
    case MountFinder::View::kUnknown:
      return from_above;
    case MountFinder::View::kFromAbove:
      revision_.reset();
      return from_above;
    case MountFinder::View::kLevel:
      SwitchToLevel();
      return level;
  }
  return from_above;
}

// Replaces all state except the application's settings and the frames held back by the lag.
void Tracker::SwitchToCeiling() {
  TrackerOptions options = impl_->options;
  options.models = LoadCeilingModels(impl_->models, impl_->ceiling_forest);
  options.mount = Mount::kCeiling;
  auto under_ceiling = std::make_unique<Impl>(options);
  under_ceiling->lagged = std::exchange(impl_->lagged, impl_->NothingLagged());
  under_ceiling->CopySettings(*impl_);
  level_ = std::exchange(impl_, std::move(under_ceiling));
}

// Keeps the frames held back by the lag; `level_` has the application's settings.
void Tracker::SwitchToLevel() {
  level_->lagged = std::exchange(impl_->lagged, impl_->NothingLagged());
  impl_ = std::move(level_);
  revision_.reset();
  if (impl_->scene) impl_->scene->Reset();
}

Mount Tracker::mount() const { return impl_->IsUnderCeiling() ? Mount::kCeiling : Mount::kLevel; }

// TrackFilled may replace impl_, so it comes first.
BodyFrame Tracker::Track(const depth::DepthFrame& frame) {
  BodyFrame tracked = TrackFilled(frame);
  return impl_->Play(std::move(tracked));
}

// The lag smoothing comes before the scene, whose contacts it would break.
std::optional<BodyFrame> Tracker::TrackWithLag(const depth::DepthFrame& frame) {
  BodyFrame tracked = TrackFilled(frame);
  auto late = impl_->lagged.Add(std::move(tracked));
  if (!late) return std::nullopt;
  return impl_->Play(std::move(*late));
}

std::optional<BodyFrame> Tracker::DrainLag() {
  auto held = impl_->lagged.DrainLag();
  if (!held) return std::nullopt;
  return impl_->Play(std::move(*held));
}

void Tracker::FindUpright(depth::FrameSource& source, const std::function<bool()>& idle) {
  constexpr double kLongest_s = 20.0;  // by hand: most recordings show a person before
  std::optional<double> first_s;
  while (impl_->options.turn == Turn::kAuto && !impl_->upright.is_sure() && (!idle || idle())) {
    const depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    if (read.status == depth::ReadStatus::kEnd) break;
    if (read.status != depth::ReadStatus::kFrame) continue;
    if (!first_s) first_s = read.frame.time_s;
    if (read.frame.time_s - *first_s > kLongest_s) break;
    const auto filled = depth::FillScatteredHoles(read.frame);
    impl_->FindUpright(filled ? *filled : read.frame);
  }
}

int Tracker::quarter_turns() const { return impl_->QuarterTurns(); }

int64_t Tracker::Run(depth::FrameSource& source,
                     const std::function<bool(const BodyFrame&)>& on_bodies,
                     const std::function<bool()>& idle) {
  int64_t dropped = 0;
  while (!idle || idle()) {
    const depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    dropped += read.dropped;
    if (read.status == depth::ReadStatus::kEnd) break;
    if (read.status != depth::ReadStatus::kFrame) continue;
    const auto bodies = TrackWithLag(read.frame);
    if (bodies && !on_bodies(*bodies)) return dropped;
  }
  while (const auto held = DrainLag()) {
    if (!on_bodies(*held)) break;
  }
  return dropped;
}

void Tracker::ChooseUsers(std::vector<int> ids) { impl_->chosen_ids = std::move(ids); }
void Tracker::ChooseAllUsers() { impl_->chosen_ids.reset(); }
void Tracker::SetMode(TrackingMode mode) { impl_->skeleton.mode = mode; }
void Tracker::SetTurn(Turn turn) {
  if (std::exchange(impl_->options.turn, turn) == turn) return;
  impl_->upright = {};
  impl_->DeleteTracks();
}
void Tracker::SetSmoothing(const SmoothingOptions& smoothing) {
  smoothing.Check();
  impl_->skeleton.smoothing = smoothing;
}
std::optional<std::string> Tracker::TakeWarning() { return times_.TakeWarning(); }
void Tracker::Reset() {
  times_ = {};
  if (level_) {
    level_->CopySettings(*impl_);
    impl_ = std::move(level_);
  }
  revision_.reset();
  impl_->mount_finder = {};
  impl_->upright = {};
  impl_->lagged = impl_->NothingLagged();
  impl_->DeleteTracks();
  if (impl_->scene) impl_->scene->Reset();
}
Scene* Tracker::scene() { return impl_->scene ? &*impl_->scene : nullptr; }

}  // namespace ossa::tracker
