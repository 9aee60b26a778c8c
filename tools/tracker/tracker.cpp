#include "tools/tracker/tracker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/stopwatch.h"
#include "depth/base/threads.h"
#include "depth/image/turn.h"
#include "depth/sensor/frame_source.h"
#include "forest/forest.h"
#include "recon/refine/refinement_cascade.h"
#include "tools/people/detect_people.h"
#include "tools/tracker/frame_parts_internal.h"
#include "tools/tracker/lagged_bodies_internal.h"
#include "tools/tracker/mount_finder_internal.h"
#include "tools/tracker/person_internal.h"
#include "tools/tracker/skeleton_stages_internal.h"
#include "tools/tracker/upright.h"

namespace ossa::tracker {
namespace {

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

// A refinement learned from elsewhere would be wrong without a word.
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
  if (models.from_ceiling && !from_above) models.refinement = nullptr;  // said to be level
  CheckRefinement(models, from_above);
  return models;
}

const forest::ForestModel& RequireForest(const ModelSet& models) {
  if (models.forest) return *models.forest;
  throw std::invalid_argument("TrackerOptions.models.forest = null, must be a forest");
}

unsigned FindClippedEdges(const depth::DepthFrame& frame, const std::vector<int32_t>& pixels) {
  // The sensor leaves a margin of a few pixels without readings at each border.
  const int margin = std::max(2, frame.camera.width / 64);
  unsigned edges = 0;
  for (const int32_t pixel : pixels) {
    const int u = pixel % frame.camera.width, v = pixel / frame.camera.width;
    edges |= u < margin ? kClippedLeft : 0U;
    edges |= u >= frame.camera.width - margin ? kClippedRight : 0U;
    edges |= v < margin ? kClippedTop : 0U;
    edges |= v >= frame.camera.height - margin ? kClippedBottom : 0U;
  }
  return edges;
}

// How surely somebody is in a frame that nothing is known about.
double ScorePeople(const depth::DepthFrame& frame, const people::PersonClassifier& classifier,
                   const people::PeopleOptions& options) {
  people::PeopleState nothing;
  double best = 0.0;
  for (const people::Person& person :
       people::DetectPeople(frame, classifier, nothing, options).people) {
    best = std::max(best, person.detection.score);
  }
  return best;
}

recon::JointArray<std::vector<JointProposal>> CollectProposals(
    const people::ForestEvidence& evidence, const people::JointTargets& targets) {
  recon::JointArray<std::vector<JointProposal>> proposals;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    for (const forest::Proposal& p : evidence.proposals[static_cast<size_t>(targets[j])]) {
      proposals[j].push_back({p.position_m, p.confidence, p.seen});
    }
  }
  return proposals;
}

// All but the total.
StageTimes SumTimes(const people::PeopleInFrame& seen, const std::vector<StageTimes>& of_people) {
  StageTimes sum;
  sum.segment = seen.segment_ms;
  sum.classify = seen.classify_ms;
  sum.propose = seen.propose_ms;
  for (const StageTimes& t : of_people) {
    sum.propose += t.propose;
    sum.reconstruct += t.reconstruct;
    sum.physics += t.physics;
    sum.fit += t.fit;
  }
  return sum;
}

}  // namespace

struct Tracker::Impl {
  TrackerOptions options;
  ModelSet models;
  const forest::ForestModel& model;  // of `models`
  people::JointTargets targets;
  SkeletonOptions skeleton;
  people::PeopleOptions people_options;
  people::PeopleState people_state;
  std::map<int, Person> persons;  // by id
  std::optional<std::vector<int>> chosen_ids;
  UprightFinder upright;
  MountFinder mount_finder;
  // Read when a ceiling was suspected.
  std::shared_ptr<const forest::ForestModel> ceiling_forest;
  LaggedBodies lagged;
  std::optional<Scene> scene;

  explicit Impl(const TrackerOptions& o)
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
    recon::MakeReconstructor(skeleton.reconstructor);  // says now what is wrong with the options
    for (const auto& [id, lengths_m] : o.bones_m) MethodFor(id, skeleton);
    if (IsUnderCeiling()) people_options = people::PeopleOptionsFromAbove();
    // Under the ceiling people are near, but known by the floor, which is farther.
    people_options.scene.max_depth_m = o.near_range && !IsUnderCeiling() ? 3.0F : 6.0F;
    people_options.initiation.max_users = o.max_users;
    people_options.threads = o.threads;
    people_options.trace_surfaces = o.trace;
  }

  LaggedBodies NothingLagged() const {
    return LaggedBodies(
        recon::LagOptions::Of(options.lag, recon::RequireMethod(options.method).keeps_bones));
  }
  BodyFrame Track(const depth::DepthFrame& frame);
  bool IsUnderCeiling() const { return IsFromAbove(options.mount, models); }
  // What the application set meanwhile.
  void CopySettings(const Impl& other) {
    chosen_ids = other.chosen_ids;
    skeleton.mode = other.skeleton.mode;
    skeleton.smoothing = other.skeleton.smoothing;
    if (options.turn != other.options.turn) upright = {};
    options.turn = other.options.turn;
  }
  bool ShowsCeilingView(const depth::DepthFrame& frame, const BodyFrame& tracked);
  BodyFrame TrackTurned(const depth::DepthFrame& frame);
  BodyFrame Play(BodyFrame frame);
  int QuarterTurns() const {
    return options.turn == Turn::kAuto ? upright.quarters() : static_cast<int>(options.turn);
  }
  bool KeepsParts() const { return options.keep_parts || options.keep_probabilities; }
  void FindUpright(const depth::DepthFrame& frame);
  void ForgetAll();
  Body MakeBody(const depth::DepthFrame& frame, const people::Person& person) const;
  void WithdrawUnlikeBodies(const std::vector<people::Person>& seen, BodyFrame& result);
  std::vector<Person*> RememberPersons(const std::vector<Body>& bodies, double time_s);
  void Introduce(int id, Person& person) const;
};

// Whether a frame that was tracked as a level camera's is one from the ceiling: it has the floor
// and a head high over it, and the forest for ceilings is sure of a body. What the level one says
// of such frames counts for nothing: of half of the real ones it is sure, too, and wrong.
bool Tracker::Impl::ShowsCeilingView(const depth::DepthFrame& frame, const BodyFrame& tracked) {
  if (options.mount != Mount::kAuto || models.ceiling_file.empty()) return false;
  if (!mount_finder.IsDue(tracked)) return false;
  people::PeopleOptions from_above = people::PeopleOptionsFromAbove();
  const MountOptions& mount = mount_finder.options();
  from_above.candidates.overhead->min_head_m = mount.min_head_m;
  if (!MayBeFromAbove(frame, from_above, mount)) return mount_finder.Confirm(false);
  if (!ceiling_forest) ceiling_forest = LoadCeilingForest(models);
  const auto above_targets = people::FindJointTargets(*ceiling_forest, models.ceiling_file);
  return mount_finder.Confirm(ScorePeople(frame, {*ceiling_forest, above_targets}, from_above) >=
                              mount.sure);
}

void Tracker::Impl::FindUpright(const depth::DepthFrame& frame) {
  const bool changed = upright.Look(frame, [this](const depth::DepthFrame& looked, int quarters) {
    return ScorePeople(depth::Turned(looked, quarters), {model, targets}, people_options);
  });
  if (changed) ForgetAll();
}

void Tracker::Impl::ForgetAll() {
  persons.clear();
  people_state = {};
}

// What is known of a person without their joints.
Body Tracker::Impl::MakeBody(const depth::DepthFrame& frame, const people::Person& person) const {
  const people::Candidate& seen = person.detection.candidate;
  Body body;
  body.id = person.id;
  body.position_m = seen.region.mean_m.cast<double>();
  body.clipped_edges = FindClippedEdges(frame, seen.pixels);
  body.person_score = person.detection.score;
  const bool chosen = !chosen_ids || std::find(chosen_ids->begin(), chosen_ids->end(), body.id) !=
                                         chosen_ids->end();
  body.state = chosen ? BodyState::kTracked : BodyState::kPositionOnly;
  return body;
}

// Of somebody new: what is known already. The refinement cascade estimates the bones that the
// method ends with.
void Tracker::Impl::Introduce(int id, Person& person) const {
  person.id = id;
  const auto shape = options.shapes.find(id);
  if (shape != options.shapes.end()) person.shape = shape->second;
  const auto known = options.bones_m.find(id);
  if (known != options.bones_m.end() && skeleton.reconstructor.best.refined_joints) {
    person.bones.StartKnown(known->second);
  }
}

std::vector<Person*> Tracker::Impl::RememberPersons(const std::vector<Body>& bodies,
                                                    double time_s) {
  std::vector<int> ids;
  for (const Body& body : bodies) ids.push_back(body.id);
  ForgetGone(ids, time_s, people_options.association.reidentify.forget_occluded_s, persons);
  std::vector<Person*> in_view;
  for (const int id : ids) {
    Person& person = persons[id];
    if (person.id != id) Introduce(id, person);
    person.seen_s = time_s;
    in_view.push_back(&person);
  }
  return in_view;
}

// A second opinion on who was accepted at the first look: furniture may look like a person once,
// but no body's surface explains it. `seen` and result.bodies are of the same order.
void Tracker::Impl::WithdrawUnlikeBodies(const std::vector<people::Person>& seen,
                                         BodyFrame& result) {
  const people::InitiationOptions& initiation = people_options.initiation;
  const auto is_doubtful = [&](const people::Person& person) {
    return people::IsDoubtfulAtFirst(person.detection, initiation);
  };
  const bool somebody_is_sure = !std::all_of(seen.begin(), seen.end(), is_doubtful);
  for (size_t i = seen.size(); i-- > 0;) {
    const Body& body = result.bodies[i];
    if (!body.fit || !is_doubtful(seen[i])) continue;
    const people::ExplainedShares fit{body.fit->explained, body.fit->score};
    if (!people::IsUnlikeABody(fit, body.person_score, somebody_is_sure, initiation)) continue;
    ClearParts(body.id, result);
    people::Withdraw(body.id, people_state, result.users, result.decisions);
    persons.erase(body.id);
    result.bodies.erase(result.bodies.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

BodyFrame Tracker::Impl::Track(const depth::DepthFrame& frame) {
  const Stopwatch watch;
  BodyFrame result;
  result.index = frame.index;
  result.time_s = frame.time_s;
  people::PeopleInFrame seen = people::DetectPeople(frame, {model, targets, skeleton.pose_network},
                                                    people_state, people_options);
  if (seen.floor) {
    result.floor = seen.floor->coefficients;
    result.tilt_down_rad = seen.floor->TiltDown_rad();
  }
  result.users = std::move(seen.users);
  result.decisions = std::move(seen.decisions);
  for (const people::Person& person : seen.people) result.bodies.push_back(MakeBody(frame, person));
  const std::vector<Person*> in_view = RememberPersons(result.bodies, frame.time_s);
  if (KeepsParts()) result.parts = depth::Image<uint8_t>(frame.camera.width, frame.camera.height);
  if (options.keep_probabilities) result.probabilities = NobodyIn(frame, model);
  std::vector<StageTimes> times(result.bodies.size());
  ParallelFor(result.bodies.size(), options.threads, [&](size_t i) {
    Body& body = result.bodies[i];
    if (body.state == BodyState::kPositionOnly) return;
    const people::Detection& detection = seen.people[i].detection;
    SkeletonWork work{skeleton, frame, result.floor, &detection, *in_view[i], body};
    TrackSkeleton(work, times[i]);
    if (options.keep_proposals) body.proposals = CollectProposals(detection.evidence, targets);
    if (!KeepsParts()) return;
    const auto classes =
        people::LabelParts(model, frame, detection.candidate, detection.evidence, result.parts);
    if (options.keep_probabilities) AddProbabilities(classes, result.probabilities);
  });
  WithdrawUnlikeBodies(seen.people, result);
  result.ms = SumTimes(seen, times);
  std::sort(result.bodies.begin(), result.bodies.end(),
            [](const Body& a, const Body& b) { return a.id < b.id; });
  result.ms.total = watch.milliseconds();
  return result;
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

/// The last thing that is done to a frame: all people in one world.
BodyFrame Tracker::Impl::Play(BodyFrame frame) {
  if (!scene) return frame;
  const Stopwatch watch;
  scene->Play(frame);
  const double ms = watch.milliseconds();
  frame.ms.physics += ms;
  frame.ms.total += ms;
  return frame;
}

/// In the camera's own space, whichever way up it is.
BodyFrame Tracker::Impl::TrackTurned(const depth::DepthFrame& frame) {
  const std::string name = "frame " + std::to_string(frame.index);
  depth::CheckCamera(frame.camera, name + ": camera");
  if (!std::isfinite(frame.time_s)) {
    throw InputError(name + ": expected a finite time_s, found " + std::to_string(frame.time_s));
  }
  const auto pixels = static_cast<int64_t>(frame.pixel_count());
  if (pixels != static_cast<int64_t>(frame.camera.width) * frame.camera.height ||
      frame.view().width != frame.camera.width) {
    throw InputError(name + ": expected " + std::to_string(frame.camera.width) + "x" +
                     std::to_string(frame.camera.height) + " depth values, found " +
                     std::to_string(pixels));
  }
  const bool is_auto = options.turn == Turn::kAuto;
  if (is_auto) FindUpright(frame);
  const int quarters = QuarterTurns();
  BodyFrame result = quarters == 0 ? Track(frame) : Track(depth::Turned(frame, quarters));
  TurnBack(result, quarters);
  if (!result.bodies.empty()) upright.Followed(frame.time_s);
  return result;
}

// In the camera's own space, whichever way up it is; from then on with the models of where it is.
BodyFrame Tracker::TrackAsMounted(const depth::DepthFrame& frame) {
  BodyFrame result = impl_->TrackTurned(frame);
  if (!impl_->ShowsCeilingView(frame, result)) return result;
  SwitchToCeiling();
  return impl_->TrackTurned(frame);
}

// Everything anew but for what the application set meanwhile and the frames held back.
void Tracker::SwitchToCeiling() {
  TrackerOptions options = impl_->options;
  options.models = LoadCeilingModels(impl_->models, impl_->ceiling_forest);
  options.mount = Mount::kCeiling;
  auto under_ceiling = std::make_unique<Impl>(options);
  under_ceiling->lagged = std::exchange(impl_->lagged, impl_->NothingLagged());
  under_ceiling->CopySettings(*impl_);
  level_ = std::exchange(impl_, std::move(under_ceiling));
}

Mount Tracker::mount() const { return impl_->IsUnderCeiling() ? Mount::kCeiling : Mount::kLevel; }

// Tracked first: that may exchange impl_.
BodyFrame Tracker::Track(const depth::DepthFrame& frame) {
  BodyFrame tracked = TrackAsMounted(frame);
  return impl_->Play(std::move(tracked));
}

// Smoothed first: what touches in the world is not moved apart.
std::optional<BodyFrame> Tracker::TrackWithLag(const depth::DepthFrame& frame) {
  BodyFrame tracked = TrackAsMounted(frame);
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
  constexpr double kLongest_s = 20.0;  // by hand: people come into view before
  std::optional<double> first_s;
  while (impl_->options.turn == Turn::kAuto && !impl_->upright.is_sure() && (!idle || idle())) {
    const depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    if (read.status == depth::ReadStatus::kEnd) break;
    if (read.status != depth::ReadStatus::kFrame) continue;
    if (!first_s) first_s = read.frame.time_s;
    if (read.frame.time_s - *first_s > kLongest_s) break;
    impl_->FindUpright(read.frame);
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
  impl_->ForgetAll();
}
void Tracker::SetSmoothing(const SmoothingOptions& smoothing) {
  smoothing.Check();
  impl_->skeleton.smoothing = smoothing;
}
void Tracker::Reset() {
  if (level_) {
    level_->CopySettings(*impl_);
    impl_ = std::move(level_);
  }
  impl_->mount_finder = {};
  impl_->upright = {};
  impl_->lagged = impl_->NothingLagged();
  impl_->ForgetAll();
  if (impl_->scene) impl_->scene->Reset();
}
Scene* Tracker::scene() { return impl_->scene ? &*impl_->scene : nullptr; }

}  // namespace ossa::tracker
