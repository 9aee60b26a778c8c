// Processing one frame: detection, skeletons, image rotation, camera mount.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/stopwatch.h"
#include "depth/base/threads.h"
#include "depth/image/turn.h"
#include "tools/tracker/frame_parts_internal.h"
#include "tools/tracker/skeleton_stages_internal.h"
#include "tools/tracker/tracker_internal.h"

namespace ossa::tracker {
namespace {

unsigned FindClippedEdges(const depth::DepthFrame& frame, const std::vector<int32_t>& pixels) {
  // Sensors leave a margin of a few pixels without readings at each border.
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

// The person with the highest score in a single frame, without state.
TurnScore ScorePeople(const depth::DepthFrame& frame, const people::PersonClassifier& classifier,
                      const people::PeopleOptions& options) {
  people::PeopleState empty_state;
  TurnScore best;
  for (const people::Person& person :
       people::DetectPeople(frame, classifier, empty_state, options).people) {
    if (person.detection.score <= best.score) continue;
    best.score = person.detection.score;
    const people::Candidate& candidate = person.detection.candidate;
    const Eigen::Vector3f extent_m = candidate.region.high_m - candidate.region.low_m;
    best.is_doubtful =
        FindClippedEdges(frame, candidate.pixels) != 0 || extent_m.x() > extent_m.y();
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

// All times except the total.
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

void CheckFrame(const depth::DepthFrame& frame) {
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
}

// Whether a frame that was tracked with the level models is from a camera under the ceiling: a
// floor, a head high above it, and a confident person score of the ceiling forest. A high level
// score alone is no evidence, because half of the real ceiling frames have one.
bool Tracker::Impl::ShowsCeilingView(const depth::DepthFrame& frame, const BodyFrame& tracked) {
  if (options.mount != Mount::kAuto || models.ceiling_file.empty()) return false;
  if (!mount_finder.IsDue(tracked)) return false;
  const int quarters = QuarterTurns();
  return quarters == 0 ? ConfirmCeilingView(frame, tracked)
                       : ConfirmCeilingView(depth::Turned(frame, quarters), tracked);
}

bool Tracker::Impl::ConfirmCeilingView(const depth::DepthFrame& frame, const BodyFrame& tracked) {
  people::PeopleOptions from_above = people::PeopleOptionsFromAbove();
  const MountOptions& mount = mount_finder.options();
  from_above.candidates.overhead->min_head_m = mount.min_head_m;
  using View = MountFinder::View;
  if (!MayBeFromAbove(frame, mount_finder.MayBeCutBelow(tracked), from_above, mount)) {
    return mount_finder.Confirm(ShowsPerson(tracked) ? View::kLevel : View::kUnknown);
  }
  if (!ceiling_forest) ceiling_forest = LoadCeilingForest(models);
  const auto above_targets = people::FindJointTargets(*ceiling_forest, models.ceiling_file);
  const double score = ScorePeople(frame, {*ceiling_forest, above_targets}, from_above).score;
  const double sure = SeemsLevel(tracked, mount) ? mount.sure_despite_level : mount.sure;
  return mount_finder.Confirm(score >= sure ? View::kFromAbove : View::kLevel);
}

void Tracker::Impl::FindUpright(const depth::DepthFrame& frame) {
  const bool changed = upright.Update(frame, [this](const depth::DepthFrame& looked, int quarters) {
    return ScorePeople(depth::Turned(looked, quarters), {model, targets, skeleton.pose_network},
                       people_options);
  });
  if (changed) DeleteTracks();
}

void Tracker::Impl::DeleteTracks() {
  persons.clear();
  people_state = {};
}

// A body without joints.
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

// Initialises a new person with known shape and bone lengths. The refinement cascade estimates the
// bone lengths that the method uses.
void Tracker::Impl::InitializePerson(int id, Person& person) const {
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
  DeleteGone(ids, time_s, people_options.association.reidentify.forget_occluded_s, persons);
  std::vector<Person*> in_view;
  for (const int id : ids) {
    Person& person = persons[id];
    if (person.id != id) InitializePerson(id, person);
    person.seen_s = time_s;
    in_view.push_back(&person);
  }
  return in_view;
}

// Verifies new people: furniture may have a high score once, but no body's surface explains it.
// `seen` and result.bodies are in the same order.
void Tracker::Impl::WithdrawUnlikeBodies(const std::vector<people::Person>& seen,
                                         BodyFrame& result) {
  const people::InitiationOptions& initiation = people_options.initiation;
  const auto needs_check = [&](const people::Person& person) {
    return people::NeedsSurfaceCheck(person.detection, initiation);
  };
  const bool has_certain_person = !std::all_of(seen.begin(), seen.end(), needs_check);
  for (size_t i = seen.size(); i-- > 0;) {
    const Body& body = result.bodies[i];
    if (!body.fit || !needs_check(seen[i])) continue;
    const people::ExplainedShares fit{body.fit->explained, body.fit->score};
    if (!people::IsPoorBodyFit(fit, seen[i].detection, has_certain_person, initiation)) continue;
    ClearParts(body.id, result);
    people::WithdrawPerson(seen[i], result.time_s, people_state, result.users, result.decisions);
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
  if (options.keep_probabilities) result.probabilities = ZeroProbabilities(frame, model);
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

/// The last step: simulates all people in one scene.
BodyFrame Tracker::Impl::Play(BodyFrame frame) {
  if (!scene) return frame;
  const Stopwatch watch;
  scene->Play(frame);
  const double ms = watch.milliseconds();
  frame.ms.physics += ms;
  frame.ms.total += ms;
  return frame;
}

/// Tracks in the upright image; the result is in the camera's own space.
BodyFrame Tracker::Impl::TrackTurned(const depth::DepthFrame& frame) {
  if (options.turn == Turn::kAuto) FindUpright(frame);
  const int quarters = QuarterTurns();
  BodyFrame result = quarters == 0 ? Track(frame) : Track(depth::Turned(frame, quarters));
  TurnBack(result, quarters);
  if (!result.bodies.empty()) upright.NoteTracked(frame.time_s);
  return result;
}

}  // namespace ossa::tracker
