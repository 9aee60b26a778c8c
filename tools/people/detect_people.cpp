#include "tools/people/detect_people.h"

#include <algorithm>

#include "depth/base/stopwatch.h"
#include "tools/people/classify_candidates.h"
#include "tools/people/measure_body.h"
#include "tools/people/propose_candidates.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

// Tracks that may still be somebody's in this frame.
void ForgetTracks(const Scene& scene, double time_s, const ReidentifyOptions& options,
                  std::vector<Track>& tracks) {
  std::erase_if(tracks, [&](const Track& track) {
    return scene.changed || IsForgotten(track, time_s, options);
  });
}

std::vector<uint8_t> MarkCells(const PointGrid& grid, const std::vector<Detection>& people) {
  std::vector<uint8_t> marked(static_cast<size_t>(grid.cells()), 0);
  for (const Detection& person : people) {
    for (const int cell : person.candidate.region.cells) marked[static_cast<size_t>(cell)] = 1;
  }
  return marked;
}

void PaintUser(int id, const Candidate& candidate, depth::Image<uint8_t>& users) {
  for (const int32_t pixel : candidate.pixels)
    users.data[static_cast<size_t>(pixel)] = static_cast<uint8_t>(id);
}

// The time of the observations, wasted ones too, shared out as the people's own stages stand.
void ShareOutTime(double frame_ms, double look_ms, PeopleInFrame& result) {
  double classify_ms = 1e-6, propose_ms = 0;
  for (const Person& person : result.people) {
    classify_ms += person.detection.evidence.classify_ms;
    propose_ms += person.detection.evidence.propose_ms;
  }
  result.classify_ms = look_ms * classify_ms / (classify_ms + propose_ms);
  result.propose_ms = look_ms - result.classify_ms;
  result.segment_ms = frame_ms - look_ms;
}

}  // namespace

PeopleInFrame DetectPeople(const DepthFrame& frame, const PersonClassifier& classifier,
                           PeopleState& state, const PeopleOptions& options) {
  const Stopwatch watch;
  const double time_s = frame.time_s;
  PeopleInFrame result;
  auto& decided = result.decisions.candidates;

  // Geometry.
  const Scene scene = depth::MeasureScene(frame, state.scene, options.scene);
  result.floor = scene.floor;
  result.decisions.fresh_scene = scene.fresh;

  // Candidates.
  std::vector<Track>& tracks = state.tracks.tracks;
  ForgetTracks(scene, time_s, options.association.reidentify, tracks);
  Candidates proposed = ProposeCandidates(frame, scene, tracks, options.association.reidentify,
                                          options.candidates, options.trace_surfaces);
  decided = std::move(proposed.excluded);
  const std::vector<Region> rivals = FindRivals(proposed.candidates);

  // The forest's word on them, and decisions.
  const Stopwatch look_watch;
  auto selected = SelectCandidates(std::move(proposed.candidates), scene.fresh, time_s, options,
                                   state.tentative, decided);
  auto detections =
      ClassifyCandidates({classifier, frame, scene, tracks, options}, std::move(selected), decided);
  auto people = SelectPeople(std::move(detections), scene.fresh, time_s, options.initiation,
                             state.tentative, decided);
  for (Detection& person : people)
    CropToBody(classifier.targets, frame, scene, options.classification, person);
  const double look_ms = look_watch.milliseconds();

  // Identities.
  for (Detection& person : people) {
    person.measures =
        MeasureBody(person.evidence, classifier.targets, scene.floor, options.measure);
    person.keypoints_m = SelectKeypoints(person.evidence, classifier.targets, options.measure);
  }
  const std::vector<int> ids =
      AssociateTracks(scene, rivals, people, time_s, state.tracks, options.association);

  // User pixels, and the background: all that is nobody's.
  depth::LearnBackground(scene.grid, MarkCells(scene.grid, people), state.scene.background,
                         options.scene.background);
  result.users = depth::Image<uint8_t>(frame.camera.width, frame.camera.height);
  for (size_t i = 0; i < people.size(); ++i) {
    PaintUser(ids[i], people[i].candidate, result.users);
    people[i].decision.track = ids[i];
    decided.push_back(people[i].decision);
    result.people.push_back({ids[i], std::move(people[i])});
  }
  result.decisions.tracks = SummarizeTracks(tracks, ids);
  ShareOutTime(watch.milliseconds(), look_ms, result);
  return result;
}

PeopleOptions PeopleOptionsFromAbove() {
  // Lengths: anthropometry, over the surface from the top of the head. By hand on rendered people.
  PeopleOptions options;
  options.scene.floor = depth::FloorOptionsFromAbove();
  options.candidates.overhead = OverheadOptions{};
  options.evidence.from_above = true;
  options.candidates.seeds.sideways = 1.0F;
  options.candidates.seeds.jump_cost_m = 0.0F;
  options.candidates.seeds.max_reach_m = 2.2F;
  options.candidates.seeds.one_person_m2 = 0.7F;
  options.initiation.new_person = 0.5;  // 91 % of the people, 8 % of other things
  options.initiation.least_body = options.initiation.least_other_body = 0.0;  // it hides too much
  return options;
}

bool IsDoubtfulAtFirst(const Detection& detection, const InitiationOptions& options) {
  const Rule rule = detection.decision.rule;
  const bool first = rule == Rule::kFreshScene || rule == Rule::kPieceWithHead;
  if (!first || detection.age > 1) return false;
  return detection.judge == Judge::kSurfaceFit ||
         (detection.judge == Judge::kForest && detection.score < options.sure_person);
}

bool IsUnlikeABody(const ExplainedShares& fit, double person_score, bool beside_somebody,
                   const InitiationOptions& options) {
  if (fit.score < options.least_body) return true;
  const double all = 0.5 * (fit.explained + fit.score) + options.person_share * person_score;
  return beside_somebody && all < options.least_other_body;
}

void Withdraw(int id, PeopleState& state, depth::Image<uint8_t>& users, FrameDecisions& decisions) {
  const auto is_theirs = [id](const auto& entry) { return entry.id == id; };
  std::erase_if(state.tracks.tracks, is_theirs);
  GiveBackId(id, state.tracks);
  std::erase_if(decisions.tracks, is_theirs);
  for (Decision& decision : decisions.candidates) {
    if (decision.track != id) continue;
    decision.rule = Rule::kUnlikeABody;
    decision.track = 0;
  }
  std::replace(users.data.begin(), users.data.end(), static_cast<uint8_t>(id), uint8_t{0});
}

}  // namespace ossa::people
