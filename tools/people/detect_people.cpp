#include "tools/people/detect_people.h"

#include <algorithm>

#include "depth/base/stopwatch.h"
#include "tools/people/classify_candidates.h"
#include "tools/people/classify_detection.h"
#include "tools/people/measure_body.h"
#include "tools/people/propose_candidates.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

void DeleteOldTracks(const Scene& scene, double time_s, const ReidentifyOptions& options,
                     std::vector<Track>& tracks) {
  std::erase_if(tracks, [&](const Track& track) {
    return scene.changed || IsForgotten(track, time_s, options);
  });
}

void MarkUserPixels(int id, const Candidate& candidate, depth::Image<uint8_t>& users) {
  for (const int32_t pixel : candidate.pixels)
    users.data[static_cast<size_t>(pixel)] = static_cast<uint8_t>(id);
}

// Splits the classification time, which includes rejected candidates, in proportion to the times of
// the accepted people.
void DistributeTime(double frame_ms, double classification_ms, PeopleInFrame& result) {
  double classify_ms = 1e-6, propose_ms = 0;
  for (const Person& person : result.people) {
    classify_ms += person.detection.evidence.classify_ms;
    propose_ms += person.detection.evidence.propose_ms;
  }
  result.classify_ms = classification_ms * classify_ms / (classify_ms + propose_ms);
  result.propose_ms = classification_ms - result.classify_ms;
  result.segment_ms = frame_ms - classification_ms;
}

// The candidates that are accepted as people; the decisions on the others go to `decided`.
std::vector<Detection> ClassifyPeople(const ClassificationInput& input,
                                      std::vector<Candidate> candidates,
                                      std::vector<TentativeTrack>& tentative,
                                      ThoroughSearch& search, std::vector<Decision>& decided) {
  const PeopleOptions& options = input.options;
  const double time_s = input.frame.time_s;
  const bool fresh = input.scene.fresh;
  auto selected =
      SelectCandidates(std::move(candidates), fresh, time_s, options, tentative, decided);
  auto detections = ClassifyCandidates(input, std::move(selected), decided);
  const bool found = std::ranges::any_of(detections, [&](const Detection& detection) {
    return Passes(detection, options.initiation);
  });
  if (input.thorough) search.Note(time_s, found);
  auto people =
      SelectPeople(std::move(detections), fresh, time_s, options.initiation, tentative, decided);
  for (Detection& person : people) {
    CropToBody(input.classifier.targets, input.frame, input.scene, options.classification, person);
  }
  return people;
}

// Body measures and keypoints, by which people are associated with tracks.
void MeasurePeople(const ClassificationInput& input, std::vector<Detection>& people) {
  const JointTargets& targets = input.classifier.targets;
  const MeasureOptions& options = input.options.measure;
  for (Detection& person : people) {
    person.measures = MeasureBody(person.evidence, targets, input.scene.floor, options);
    person.keypoints_m = SelectKeypoints(person.evidence, targets, options);
  }
}

// `ids`: of `people`, in the same order.
void AddPeople(const depth::Camera& camera, const std::vector<int>& ids,
               std::vector<Detection> people, PeopleInFrame& result) {
  result.users = depth::Image<uint8_t>(camera.width, camera.height);
  for (size_t i = 0; i < people.size(); ++i) {
    MarkUserPixels(ids[i], people[i].candidate, result.users);
    people[i].decision.track = ids[i];
    result.decisions.candidates.push_back(people[i].decision);
    result.people.push_back({ids[i], std::move(people[i])});
  }
}

}  // namespace

bool ThoroughSearch::IsDue(bool fresh_scene, bool has_tracked, double time_s,
                           double every_s) const {
  constexpr int kMostInARow = 8;  // frames, by hand: who is not accepted by then is left alone
  if (fresh_scene) return true;
  if (has_tracked) return false;
  const bool goes_on = found_in_a_row_ > 0 && found_in_a_row_ < kMostInARow;
  return goes_on || time_s - last_s_ >= every_s || time_s < last_s_;
}

void ThoroughSearch::Note(double time_s, bool found) {
  last_s_ = time_s;
  found_in_a_row_ = found ? found_in_a_row_ + 1 : 0;
}

PeopleInFrame DetectPeople(const DepthFrame& frame, const PersonClassifier& classifier,
                           PeopleState& state, const PeopleOptions& usual) {
  const Stopwatch watch;
  const std::optional<double> step_s = state.rate.Update(frame.time_s);
  const PeopleOptions options = step_s ? AdaptToFrameRate(usual, *step_s) : usual;
  std::vector<Track>& tracks = state.tracks.tracks;
  PeopleInFrame result;
  auto& decided = result.decisions.candidates;

  const Scene scene = depth::MeasureScene(frame, state.scene, options.scene);
  result.floor = scene.floor;
  result.decisions.fresh_scene = scene.fresh;

  DeleteOldTracks(scene, frame.time_s, options.association.reidentify, tracks);
  Candidates proposed = ProposeCandidates(frame, scene, tracks, options.association.reidentify,
                                          options.candidates, options.trace_surfaces);
  decided = std::move(proposed.excluded);
  const std::vector<Region> rivals = FindRivals(proposed.candidates);

  const Stopwatch classification_watch;
  const bool has_tracked = std::ranges::any_of(tracks, [&](const Track& track) {
    return frame.time_s - track.last_seen_s < options.search_every_s;
  });
  const bool thorough =
      state.search.IsDue(scene.fresh, has_tracked, frame.time_s, options.search_every_s);
  const ClassificationInput input{classifier, frame, scene, tracks, options, thorough};
  std::vector<Detection> people =
      ClassifyPeople(input, std::move(proposed.candidates), state.tentative, state.search, decided);
  const double classification_ms = classification_watch.milliseconds();

  MeasurePeople(input, people);
  const std::vector<int> ids =
      AssociateTracks(scene, rivals, people, frame.time_s, state.tracks, options.association);
  for (const Detection& person : people) {
    if (person.decision.rule != Rule::kEnoughObservations) continue;
    depth::ForgetBackground(scene.grid, person.candidate.region.cells, state.scene.background,
                            options.scene.background);
  }
  std::vector<uint8_t> claimed = MarkPeople(scene, people, tracks, frame.time_s);
  MarkLikelyPeople(state.tentative, options.initiation, claimed);
  depth::LearnBackground(scene.grid, claimed, state.scene.background, options.scene.background);
  AddPeople(frame.camera, ids, std::move(people), result);
  result.decisions.tracks = SummarizeTracks(tracks, ids);
  DistributeTime(watch.milliseconds(), classification_ms, result);
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
  options.initiation.new_person_score = 0.5;  // 91 % of the people, 8 % of other objects
  options.initiation.min_fit_score = options.initiation.min_fit_score_beside_person =
      0.0;  // too much is occluded
  return options;
}

bool NeedsSurfaceCheck(const Detection& detection, const InitiationOptions& options) {
  const Rule rule = detection.decision.rule;
  const bool first = rule == Rule::kFreshScene || rule == Rule::kPieceWithHead;
  if (rule == Rule::kEnoughObservations)
    return detection.was_withdrawn || detection.verifier == Verifier::kSurfaceFit;
  if (!first || detection.age > 1) return false;
  return detection.verifier == Verifier::kSurfaceFit ||
         (detection.verifier == Verifier::kForest && detection.score < options.confident_score);
}

bool IsPoorBodyFit(const ExplainedShares& fit, const Detection& detection, bool beside_person,
                   const InitiationOptions& options) {
  const bool contested = detection.verifier == Verifier::kSurfaceFit &&
                         detection.candidate.region.mean_m.z() > options.contested_beyond_m;
  if (fit.score < (contested ? options.min_fit_score_contested : options.min_fit_score))
    return true;
  const double all =
      0.5 * (fit.explained + fit.score) + options.person_score_weight * detection.score;
  return beside_person && all < options.min_fit_score_beside_person;
}

void WithdrawPerson(const Person& person, double time_s, PeopleState& state,
                    depth::Image<uint8_t>& users, FrameDecisions& decisions) {
  const int id = person.id;
  const auto is_theirs = [id](const auto& entry) { return entry.id == id; };
  std::erase_if(state.tracks.tracks, is_theirs);
  ReleaseId(id, state.tracks);
  std::erase_if(decisions.tracks, is_theirs);
  for (Decision& decision : decisions.candidates) {
    if (decision.track != id) continue;
    decision.rule = Rule::kUnlikeABody;
    decision.track = 0;
  }
  std::replace(users.data.begin(), users.data.end(), static_cast<uint8_t>(id), uint8_t{0});
  TentativeTrack track = StartTentative(person.detection, time_s);
  track.was_rejected = track.was_withdrawn = true;
  state.tentative.push_back(std::move(track));
}

}  // namespace ossa::people
