#include "tools/tracker/tracker.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/large_pages.h"
#include "depth/scene/scene.h"
#include "depth/sensor/frame_source.h"
#include "forest/forest.h"
#include "recon/database/posture_database.h"
#include "recon/models/learned_models.h"
#include "recon/refine/close_look.h"
#include "tools/tracker/find_people_internal.h"
#include "tools/tracker/look_closely_internal.h"
#include "tools/tracker/measure_body_internal.h"
#include "tools/tracker/parallel_internal.h"
#include "tools/tracker/perceive_internal.h"
#include "tools/tracker/person_internal.h"
#include "tools/tracker/shipped.h"

namespace ossa::tracker {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMoving_s = 1.0;  // since the last shift; who is new may not have shifted yet
constexpr double kRecent_s = 0.2;  // what was seen longer ago says nothing about now

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string ModelPath(const TrackerOptions& options) {
  return options.model.empty() ? ShippedFile("body.ossa").string() : options.model;
}

// Methods that look postures up take the shipped database unless another is named.
std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const TrackerOptions& options) {
  if (options.database.empty() && !recon::NeedsDatabase(options.method)) return nullptr;
  const std::string path =
      options.database.empty() ? ShippedFile("authored.ossadb").string() : options.database;
  return std::make_shared<recon::PostureDatabase>(recon::PostureDatabase::Load(path));
}

// What best knows of the errors that a close look leaves in the shipped forest's joints is shipped
// with them (tools/train_correction). Of other joints it is known that their forest was shown our
// own bodies: bones are expected in the proportions of the standard body.
std::shared_ptr<const recon::LearnedModels> LoadLearned(const TrackerOptions& options,
                                                        bool looked) {
  if (looked && (options.model.empty() || IsShippedFile(options.model, "body.ossa"))) {
    return std::make_shared<recon::LearnedModels>(
        recon::LearnedModels::Load(ShippedFile("body.ossagp")));
  }
  auto models = std::make_shared<recon::LearnedModels>();
  models->correction.proportions.fill(1.0);
  return models;
}

std::shared_ptr<const recon::Looker> LookOf(const TrackerOptions& options) {
  const bool is_shipped = options.model.empty() || IsShippedFile(options.model, "body.ossa");
  if (options.look == "none") return nullptr;
  if (options.look.empty() && !(is_shipped && options.method == "best")) return nullptr;
  auto look = std::make_shared<recon::Looker>(
      recon::CloseLook::Load(options.look.empty() ? ShippedFile(recon::kShippedLook)
                                                  : std::filesystem::path(options.look)));
  ReturnFreedMemory();
  return look;
}

unsigned ClippedEdges(const depth::DepthFrame& frame, const std::vector<int32_t>& pixels) {
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

}  // namespace

struct Tracker::Impl {
  TrackerOptions options;
  std::shared_ptr<const recon::Looker> look;  // before the forest: see ReturnFreedMemory
  forest::ForestModel model;
  recon::JointArray<int> targets;
  CompleteOptions complete;
  depth::SceneOptions scene_options;
  depth::SceneState scene_state;
  FinderState finder_state;
  std::map<int, Person> people;
  std::optional<std::vector<int>> chosen_ids;

  explicit Impl(const TrackerOptions& o)
      : options(o),
        look(LookOf(o)),
        model(forest::ReadForestModel(ModelPath(o), forest::ModelUse::kRunOnly)),
        targets(JointTargets(model, o.model.empty() ? "body.ossa" : o.model)) {
    complete.physics = o.physics;
    complete.mechanics = o.mechanics;
    complete.smoothing = o.smoothing;
    complete.reconstructor.method = o.method;
    complete.reconstructor.database = LoadDatabase(o);
    complete.reconstructor.prior = PriorFor(o.method, o.prior, o.database);
    const bool none = o.learned == "none";
    if (!none && !o.learned.empty()) {
      complete.reconstructor.learned_file = o.learned;  // for messages; it is read once
      complete.reconstructor.learned =
          std::make_shared<recon::LearnedModels>(recon::LearnedModels::Load(o.learned));
    } else if (o.method == "best") {
      complete.reconstructor.learned = LoadLearned(o, look != nullptr && !none);
    }
    complete.reconstructor.best.looked = look != nullptr;
    complete.reconstructor.seed = o.seed;
    complete.bones_m = o.bones_m;
    recon::MakeReconstructor(complete.reconstructor);  // says now what is wrong with the options
    for (const auto& [id, lengths_m] : o.bones_m) MethodFor(id, complete);
    scene_options.max_depth_m = o.near_range ? 3.0F : 6.0F;
    ReturnFreedMemory();
  }

  BodyFrame Track(const depth::DepthFrame& frame);
  std::vector<Found> Segment(const depth::DepthFrame& frame, BodyFrame& result);
  Known KnownOf(const depth::Candidate& candidate, double time_s) const;
  std::vector<Person*> PersonsOf(const std::vector<int>& ids, double time_s);
  void Introduce(int id, Person& person) const;
  std::vector<float> ContextPrior(const Person& person, double time_s) const;
  void TrackBody(const depth::DepthFrame& frame, const std::optional<Eigen::Vector4d>& floor,
                 const Found& found, Person& person, Body& body, StageTimes& ms) const;
};

Known Tracker::Impl::KnownOf(const depth::Candidate& candidate, double time_s) const {
  if (candidate.track < 0) return {};
  const auto& user = scene_state.users[static_cast<size_t>(candidate.track)];
  const auto found = people.find(user.id);
  if (found == people.end()) return {};
  const Person& person = found->second;
  Known known;
  known.context_prior = ContextPrior(person, time_s);
  known.person_score = person.score;
  known.looks = person.looks;
  known.moved = user.moved;
  known.moving = time_s - user.moved_s < kMoving_s;
  known.full_m2 = user.full_m2;
  return known;
}

// Who is where: fills floor, user image and the bodies' outer facts.
std::vector<Found> Tracker::Impl::Segment(const depth::DepthFrame& frame, BodyFrame& result) {
  const auto start = Clock::now();
  depth::SceneState next;
  const depth::Scene scene = depth::FindCandidates(frame, scene_state, next, scene_options);
  scene_state = std::move(next);
  if (scene.floor) {
    result.floor = scene.floor->coefficients;
    result.tilt_down_rad = scene.floor->TiltDown_rad();
  }
  FindOptions find;
  find.max_users = options.max_users;
  find.threads = options.threads;
  const Eyes eyes{model, targets, [&](const depth::Candidate& candidate) {
                    return KnownOf(candidate, frame.time_s);
                  }};
  const auto look_start = Clock::now();
  std::vector<Found> found = FindPeople(eyes, frame, scene, scene_options, find, finder_state);
  const double look_ms = MillisecondsSince(look_start);
  std::vector<const depth::Candidate*> users;
  for (Found& one : found) {
    one.candidate.body = MeasureBody(one.perception, targets, scene.floor);
    one.candidate.marks_m = SureJoints(one.perception, targets);
    users.push_back(&one.candidate);
  }
  const std::vector<int> ids =
      depth::ConfirmUsers(scene, users, frame.time_s, scene_state, scene_options);
  result.users = depth::UserImage(frame, users, ids);
  result.bodies.resize(ids.size());
  for (size_t i = 0; i < ids.size(); ++i) {
    Body& body = result.bodies[i];
    body.id = ids[i];
    body.position_m = users[i]->region.mean_m.cast<double>();
    body.clipped_edges = ClippedEdges(frame, users[i]->pixels);
    body.person_score = found[i].perception.person_score;
    const bool chosen = !chosen_ids || std::find(chosen_ids->begin(), chosen_ids->end(), ids[i]) !=
                                           chosen_ids->end();
    body.state = chosen ? BodyState::kTracked : BodyState::kPositionOnly;
  }
  // The time of the looks, wasted ones too, shared out as the people's own stages stand.
  double classify_ms = 1e-6, propose_ms = 0;
  for (const Found& one : found) {
    classify_ms += one.perception.classify_ms;
    propose_ms += one.perception.propose_ms;
  }
  result.ms.classify = look_ms * classify_ms / (classify_ms + propose_ms);
  result.ms.propose = look_ms - result.ms.classify;
  result.ms.segment = MillisecondsSince(start) - look_ms;
  return found;
}

// Of somebody new: what is known already. A look judges the bones that the method ends with.
void Tracker::Impl::Introduce(int id, Person& person) const {
  constexpr int kFrames = 600;  // what is judged now changes little
  person.id = id;
  const auto known = options.bones_m.find(id);
  if (known != options.bones_m.end() && complete.reconstructor.best.looked) {
    person.bones = {known->second, kFrames};
  }
}

std::vector<Person*> Tracker::Impl::PersonsOf(const std::vector<int>& ids, double time_s) {
  ForgetGone(ids, time_s, scene_options.reidentify.forget_behind_s, people);
  std::vector<Person*> persons;
  for (const int id : ids) {
    Person& person = people[id];
    if (person.id != id) Introduce(id, person);
    if (person.seen_s == 0.0 || person.seen_s > time_s) person.seen_s = time_s;
    persons.push_back(&person);
  }
  return persons;
}

// Which way a person faced a moment ago says much of the way now.
std::vector<float> Tracker::Impl::ContextPrior(const Person& person, double time_s) const {
  // ... but first it must be clear that it is a person: on furniture the belief feeds itself.
  constexpr int kFewLooks = 12;
  if (person.looks < kFewLooks) return {};
  if (person.context.empty() || time_s - person.before_s > kRecent_s) return {};
  // A twentieth starts anew, so that an error does not keep itself alive.
  constexpr float kFresh = 0.05F;
  std::vector<float> prior = person.context;
  for (float& share : prior)
    share = (1 - kFresh) * share + kFresh / static_cast<float>(prior.size());
  return prior;
}

// From pixels to all three postures of one person.
void Tracker::Impl::TrackBody(const depth::DepthFrame& frame,
                              const std::optional<Eigen::Vector4d>& floor, const Found& found,
                              Person& person, Body& body, StageTimes& ms) const {
  const Perception& perception = found.perception;
  ChoiceContext context;
  context.camera = &frame.camera;
  context.expected_m = person.lengths_m;
  context.leg_area_m2 = perception.leg_area_m2;
  const bool recent = person.before && frame.time_s - person.before_s <= kRecent_s;
  context.before = recent ? &*person.before : nullptr;
  body.raw = ChoosePosture(model, targets, perception.proposals, context);
  if (look) {
    const auto start = Clock::now();
    const auto looked = LookClosely(*look, frame, found.candidate, perception.proposals, targets,
                                    body.raw, &person.bones);
    if (looked) {
      body.refined = looked->joints_m;
      body.refined_bones_m = looked->bones_m;
    }
    ms.reconstruct += MillisecondsSince(start);
  }
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    if (options.mode == TrackingMode::kStanding || IsSeatedJoint(static_cast<recon::Joint>(j)))
      continue;
    body.raw.state[j] = recon::TrackingState::kNotTracked;
    body.raw.confidence[j] = 0;
  }
  LearnBoneLengths(body.raw, person.lengths_m);
  CompleteBody(frame, floor, complete, person, body, ms);
  person.before = body.raw;
  person.context = perception.classification.context;
  person.before_s = frame.time_s;
}

BodyFrame Tracker::Impl::Track(const depth::DepthFrame& frame) {
  const auto start = Clock::now();
  BodyFrame result;
  result.index = frame.index;
  result.time_s = frame.time_s;
  const std::vector<Found> found = Segment(frame, result);
  std::vector<int> ids;
  for (const Body& body : result.bodies) ids.push_back(body.id);
  const std::vector<Person*> persons = PersonsOf(ids, frame.time_s);
  if (options.keep_parts)
    result.parts = depth::Image<uint8_t>(frame.camera.width, frame.camera.height);
  std::vector<StageTimes> times(ids.size());
  ParallelFor(ids.size(), options.threads, [&](size_t i) {
    Body& body = result.bodies[i];
    persons[i]->score = body.person_score;
    ++persons[i]->looks;
    persons[i]->seen_s = frame.time_s;
    if (body.state == BodyState::kPositionOnly) return;
    TrackBody(frame, result.floor, found[i], *persons[i], body, times[i]);
    if (options.keep_parts)
      PaintParts(model, frame, found[i].candidate, found[i].perception, result.parts);
  });
  for (const StageTimes& t : times) {
    result.ms.reconstruct += t.reconstruct;
    result.ms.physics += t.physics;
  }
  std::sort(result.bodies.begin(), result.bodies.end(),
            [](const Body& a, const Body& b) { return a.id < b.id; });
  result.ms.total = MillisecondsSince(start);
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
  smoothing.Check();
}

Tracker::Tracker(const TrackerOptions& options) {
  options.Check();
  impl_ = std::make_unique<Impl>(options);
}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

BodyFrame Tracker::Track(const depth::DepthFrame& frame) {
  const std::string name = "frame " + std::to_string(frame.index);
  depth::CheckCamera(frame.camera, name + ": camera");
  const auto pixels = static_cast<int64_t>(frame.depth_mm.size());
  if (pixels != static_cast<int64_t>(frame.camera.width) * frame.camera.height) {
    throw InputError(name + ": expected " + std::to_string(frame.camera.width) + "x" +
                     std::to_string(frame.camera.height) + " depth values, found " +
                     std::to_string(pixels));
  }
  return impl_->Track(frame);
}

int64_t Tracker::Run(depth::FrameSource& source,
                     const std::function<bool(const BodyFrame&)>& on_bodies,
                     const std::function<bool()>& idle) {
  int64_t dropped = 0;
  while (!idle || idle()) {
    const depth::ReadResult read = source.Read(std::chrono::milliseconds(100));
    if (read.status == depth::ReadStatus::kEnd) break;
    if (read.status != depth::ReadStatus::kFrame) continue;
    dropped += read.dropped;
    if (!on_bodies(Track(read.frame))) break;
  }
  return dropped;
}

void Tracker::ChooseUsers(std::vector<int> ids) { impl_->chosen_ids = std::move(ids); }
void Tracker::ChooseAllUsers() { impl_->chosen_ids.reset(); }
void Tracker::SetMode(TrackingMode mode) { impl_->options.mode = mode; }
void Tracker::SetSmoothing(const SmoothingOptions& smoothing) {
  smoothing.Check();
  impl_->complete.smoothing = smoothing;
}
void Tracker::Reset() {
  impl_->people.clear();
  impl_->scene_state = {};
  impl_->finder_state = {};
}

}  // namespace ossa::tracker
