#include "tools/tracker/tracker.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <utility>

#include "depth/error.h"
#include "depth/scene/scene.h"
#include "depth/sensor/frame_source.h"
#include "forest/forest.h"
#include "recon/database/posture_database.h"
#include "tools/tracker/parallel_internal.h"
#include "tools/tracker/perceive_internal.h"
#include "tools/tracker/person_internal.h"
#include "tools/tracker/shipped.h"

namespace ossa::tracker {
namespace {

using Clock = std::chrono::steady_clock;

// Of a newcomer, and of somebody tracked a moment ago: hysteresis keeps a person who turns away.
constexpr double kNewPerson = 0.35;
constexpr double kKnownPerson = 0.18;
constexpr size_t kMostCandidates = 12;  // looked at per frame, the largest first
constexpr double kRecent_s = 0.2;       // what was seen longer ago says nothing about now

double MillisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string ModelPath(const TrackerOptions& options) {
  return options.model.empty() ? ShippedFile("body.ossa").string() : options.model;
}

// The filters need no database; the others take the shipped one unless another is named.
std::shared_ptr<const recon::PostureDatabase> LoadDatabase(const TrackerOptions& options) {
  const bool plain = options.method == "none" || options.method == "holt" ||
                     options.method == "one-euro" || options.method == "kalman";
  if (options.database.empty() && plain) return nullptr;
  const std::string path =
      options.database.empty() ? ShippedFile("authored.ossadb").string() : options.database;
  return std::make_shared<recon::PostureDatabase>(recon::PostureDatabase::Load(path));
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

struct Seen {
  depth::Candidate candidate;
  Perception perception;
};

}  // namespace

struct Tracker::Impl {
  TrackerOptions options;
  forest::ForestModel model;
  std::array<int, recon::kJointCount> targets;
  CompleteOptions complete;
  depth::SceneOptions scene_options;
  depth::SceneState scene_state;
  std::map<int, Person> people;
  std::vector<int> chosen_ids;

  explicit Impl(const TrackerOptions& o)
      : options(o),
        model(forest::ReadForestModel(ModelPath(o))),
        targets(JointTargets(model, o.model.empty() ? "body.ossa" : o.model)) {
    complete.physics = o.physics;
    complete.mode = o.mode;
    complete.smoothing = o.smoothing;
    complete.reconstructor.method = o.method;
    complete.reconstructor.database = LoadDatabase(o);
    complete.reconstructor.learned_file = o.learned;
    complete.reconstructor.seed = o.seed;
    recon::MakeReconstructor(complete.reconstructor);  // says now what is wrong with the options
    scene_options.max_depth_m = o.near_range ? 3.0F : 6.0F;
  }

  BodyFrame Push(const depth::DepthFrame& frame);
  std::vector<Seen> FindPeople(const depth::DepthFrame& frame, const depth::Scene& scene);
  std::vector<Seen> Look(const depth::DepthFrame& frame,
                         const std::vector<depth::Candidate>& candidates) const;
  double Threshold(const depth::Candidate& candidate) const;
  std::vector<float> ContextPrior(const depth::Candidate& candidate, double time_s) const;
  std::vector<bool> FullyTracked(const std::vector<int>& ids) const;
  void FillBody(const depth::DepthFrame& frame, const std::optional<Eigen::Vector4d>& floor,
                Seen& seen, Person& person, Body& body, StageTimes& ms) const;
};

double Tracker::Impl::Threshold(const depth::Candidate& candidate) const {
  return candidate.track >= 0 ? kKnownPerson : kNewPerson;
}

// Which way a person faced a moment ago says much of the way now.
std::vector<float> Tracker::Impl::ContextPrior(const depth::Candidate& candidate,
                                               double time_s) const {
  if (candidate.track < 0) return {};
  const auto found = people.find(scene_state.users[static_cast<size_t>(candidate.track)].id);
  if (found == people.end() || found->second.context.empty() ||
      time_s - found->second.seen_s > kRecent_s) {
    return {};
  }
  // A twentieth starts anew, so that an error does not keep itself alive.
  constexpr float kFresh = 0.05F;
  std::vector<float> prior = found->second.context;
  for (float& share : prior)
    share = (1 - kFresh) * share + kFresh / static_cast<float>(prior.size());
  return prior;
}

std::vector<Seen> Tracker::Impl::Look(const depth::DepthFrame& frame,
                                      const std::vector<depth::Candidate>& candidates) const {
  std::vector<Seen> seen(candidates.size());
  ParallelFor(candidates.size(), options.threads, [&](size_t i) {
    PerceiveOptions perceive;
    perceive.context_prior = ContextPrior(candidates[i], frame.time_s);
    seen[i] = {candidates[i], Perceive(model, targets, frame, candidates[i], perceive)};
  });
  return seen;
}

// Candidates that the forest takes for people; those with two heads are cut and looked at again.
std::vector<Seen> Tracker::Impl::FindPeople(const depth::DepthFrame& frame,
                                            const depth::Scene& scene) {
  std::vector<depth::Candidate> candidates = scene.candidates;
  if (candidates.size() > kMostCandidates) candidates.resize(kMostCandidates);
  std::vector<Seen> found;
  std::vector<depth::Candidate> pieces;
  for (Seen& seen : Look(frame, candidates)) {
    if (seen.perception.heads_m.size() > 1) {
      auto cut = depth::SplitCandidate(scene, frame, seen.candidate, seen.perception.heads_m,
                                       scene_options);
      if (cut.size() > 1) {
        pieces.insert(pieces.end(), cut.begin(), cut.end());
        continue;
      }
    }
    if (seen.perception.person_score >= Threshold(seen.candidate)) found.push_back(std::move(seen));
  }
  for (Seen& seen : Look(frame, pieces)) {
    if (seen.perception.person_score >= Threshold(seen.candidate)) found.push_back(std::move(seen));
  }
  std::stable_sort(found.begin(), found.end(), [](const Seen& a, const Seen& b) {
    const bool known_a = a.candidate.track >= 0, known_b = b.candidate.track >= 0;
    if (known_a != known_b) return known_a;
    return a.perception.person_score > b.perception.person_score;
  });
  if (found.size() > static_cast<size_t>(options.max_users))
    found.resize(static_cast<size_t>(options.max_users));
  return found;
}

std::vector<bool> Tracker::Impl::FullyTracked(const std::vector<int>& ids) const {
  std::vector<bool> full(ids.size(), true);
  if (chosen_ids.empty()) return full;
  for (size_t i = 0; i < ids.size(); ++i) {
    full[i] = std::find(chosen_ids.begin(), chosen_ids.end(), ids[i]) != chosen_ids.end();
  }
  return full;
}

void Tracker::Impl::FillBody(const depth::DepthFrame& frame,
                             const std::optional<Eigen::Vector4d>& floor, Seen& seen,
                             Person& person, Body& body, StageTimes& ms) const {
  ChoiceContext context;
  context.camera = &frame.camera;
  context.expected_m = person.lengths_m;
  const bool recent = person.before && frame.time_s - person.seen_s <= kRecent_s;
  context.before = recent ? &*person.before : nullptr;
  body.raw = ChoosePosture(model, targets, seen.perception.proposals, context);
  if (options.mode == TrackingMode::kSeated) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      if (!IsSeatedJoint(static_cast<recon::Joint>(j))) {
        body.raw.state[j] = recon::TrackingState::kNotTracked;
        body.raw.confidence[j] = 0;
      }
    }
  }
  LearnBoneLengths(body.raw, person.lengths_m);
  CompleteBody(frame, floor, complete, person, body, ms);
  person.before = body.raw;
  person.context = seen.perception.classification.context;
  person.seen_s = frame.time_s;
}

BodyFrame Tracker::Impl::Push(const depth::DepthFrame& frame) {
  const auto start = Clock::now();
  BodyFrame result;
  result.index = frame.index;
  result.time_s = frame.time_s;
  depth::SceneState next;
  const depth::Scene scene = depth::FindCandidates(frame, scene_state, next, scene_options);
  scene_state = std::move(next);
  if (scene.floor) result.floor = scene.floor->coefficients;
  result.ms.segment = MillisecondsSince(start);

  const auto forest_start = Clock::now();
  std::vector<Seen> seen = FindPeople(frame, scene);
  const double forest_ms = MillisecondsSince(forest_start);
  double classify_ms = 0, propose_ms = 0;
  for (const Seen& one : seen) {
    classify_ms += one.perception.classify_ms;
    propose_ms += one.perception.propose_ms;
  }
  // Wall time, shared out as the stages' own times stand to each other.
  const double share = classify_ms + propose_ms > 0 ? classify_ms / (classify_ms + propose_ms) : 1;
  result.ms.classify = forest_ms * share;
  result.ms.propose = forest_ms * (1 - share);

  const auto identity_start = Clock::now();
  std::vector<depth::Candidate> candidates;
  for (const Seen& one : seen) candidates.push_back(one.candidate);
  const std::vector<int> ids =
      depth::ConfirmUsers(scene, candidates, frame.time_s, scene_state, scene_options);
  std::vector<const depth::Candidate*> users;
  for (const auto& candidate : candidates) users.push_back(&candidate);
  result.users = depth::UserImage(frame, users, ids);
  result.ms.segment += MillisecondsSince(identity_start);

  std::erase_if(people, [&](const auto& entry) {
    return frame.time_s - entry.second.seen_s > scene_options.forget_s;
  });
  const std::vector<bool> full = FullyTracked(ids);
  std::vector<Person*> persons;
  for (const int id : ids) {
    Person& person = people[id];
    person.id = id;
    if (person.seen_s == 0.0 || person.seen_s > frame.time_s) person.seen_s = frame.time_s;
    persons.push_back(&person);
  }
  result.bodies.resize(ids.size());
  std::vector<StageTimes> times(ids.size());
  ParallelFor(ids.size(), options.threads, [&](size_t i) {
    Body& body = result.bodies[i];
    body.id = ids[i];
    body.position_m = seen[i].candidate.region.mean_m.cast<double>();
    body.clipped_edges = ClippedEdges(frame, seen[i].candidate.pixels);
    body.person_score = seen[i].perception.person_score;
    body.state = full[i] ? BodyState::kTracked : BodyState::kPositionOnly;
    if (full[i]) FillBody(frame, result.floor, seen[i], *persons[i], body, times[i]);
  });
  for (const StageTimes& t : times) {
    result.ms.reconstruct += t.reconstruct;
    result.ms.physics += t.physics;
  }
  if (options.keep_parts) {
    result.parts = depth::Image<uint8_t>(frame.camera.width, frame.camera.height);
    for (const Seen& one : seen) {
      const auto& c = one.perception.classification;
      const int scale = one.perception.scale;
      const int width = (frame.camera.width + scale - 1) / scale;
      depth::Image<uint8_t> small(width, (frame.camera.height + scale - 1) / scale);
      for (size_t i = 0; i < c.pixel.size(); ++i)
        small.data[static_cast<size_t>(c.pixel[i])] = c.label[i];
      for (const int32_t pixel : one.candidate.pixels) {
        result.parts.data[static_cast<size_t>(pixel)] =
            small.at(pixel % frame.camera.width / scale, pixel / frame.camera.width / scale);
      }
    }
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

BodyFrame Tracker::Push(const depth::DepthFrame& frame) {
  const auto pixels = static_cast<int64_t>(frame.depth_mm.size());
  if (frame.camera.width <= 0 || frame.camera.height <= 0 ||
      pixels != static_cast<int64_t>(frame.camera.width) * frame.camera.height) {
    throw InputError("frame " + std::to_string(frame.index) + ": expected " +
                     std::to_string(frame.camera.width) + "x" +
                     std::to_string(frame.camera.height) + " depth values, found " +
                     std::to_string(pixels));
  }
  return impl_->Push(frame);
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
    if (!on_bodies(Push(read.frame))) break;
  }
  return dropped;
}

void Tracker::ChooseUsers(std::vector<int> ids) { impl_->chosen_ids = std::move(ids); }
void Tracker::SetMode(TrackingMode mode) { impl_->options.mode = mode; }
void Tracker::SetSmoothing(const SmoothingOptions& smoothing) {
  smoothing.Check();
  impl_->complete.smoothing = smoothing;
}
void Tracker::Reset() {
  impl_->people.clear();
  impl_->scene_state = {};
}

}  // namespace ossa::tracker
