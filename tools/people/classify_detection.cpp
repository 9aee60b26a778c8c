#include "tools/people/classify_detection.h"

#include <algorithm>
#include <utility>

#include "tools/people/pose_evidence.h"

namespace ossa::people {
namespace {

// The weight of the new frame in the mean over a track's frames.
double ComputeFrameWeight(int age, const TrackPriorOptions& options) {
  return std::max(1.0 / age, 1 - options.memory);
}

}  // namespace

Detection Classify(const ClassificationInput& input, Candidate candidate) {
  const PeopleOptions& options = input.options;
  Detection detection;
  detection.prior = MakeTrackPrior(candidate, input.tracks, input.frame.time_s, options.prior);
  const TrackPrior& prior = detection.prior;
  const double min_score = candidate.track >= 0 ? 0.0 : options.evidence.min_surface_score;
  detection.evidence = ClassifyCandidate(input.classifier, input.frame, candidate, prior.facing,
                                         min_score, options.evidence);
  detection.score = detection.evidence.score;
  detection.age = prior.age + 1;
  if (prior.score) {
    const double weight = ComputeFrameWeight(detection.age, options.prior);
    detection.score = *prior.score + weight * (detection.score - *prior.score);
  }
  detection.candidate = std::move(candidate);
  return detection;
}

void ApplyPoseNetwork(const ClassificationInput& input, Detection& detection) {
  const PeopleOptions& options = input.options;
  const bool is_new = detection.candidate.track < 0;
  const double forest = detection.evidence.score;
  if (forest < options.evidence.min_surface_score) return;
  // Who comes into a known scene, or back, is new but hardly furniture: like somebody tracked, they
  // can only gain by the network, which sees less of who is half hidden.
  const bool comes =
      is_new && (IsForeground(detection.candidate) || !detection.candidate.may_return_as.empty());
  const InitiationOptions& initiation = options.initiation;
  const double enough = comes ? initiation.new_person_score : initiation.confident_score;
  const bool gains_only = comes || !is_new;
  if (gains_only && forest >= enough) return;
  detection.pose = ReadPose(*input.classifier.network, input.frame, detection.candidate.pixels);
  if (!detection.pose) return;
  const double score = ComputeScoreWithPose(forest, MeasureCertainty(*detection.pose));
  if (gains_only && score < forest) return;
  const bool contested = forest >= options.initiation.confident_score &&
                         score >= options.initiation.contested_score &&
                         score < options.initiation.person_by_pose_score;
  detection.verifier = contested ? Verifier::kSurfaceFit : Verifier::kForestAndNetwork;
  if (contested) return;
  detection.score += ComputeFrameWeight(detection.age, options.prior) * (score - forest);
  detection.evidence.score = score;
}

bool Passes(const Detection& detection, const InitiationOptions& options) {
  return detection.score >=
         (IsVerifiedByPose(detection) ? options.person_by_pose_score : options.new_person_score);
}

TrackPrior MakeTrackPrior(const Candidate& candidate, const std::vector<Track>& tracks,
                          double time_s, const TrackPriorOptions& options) {
  TrackPrior prior;
  if (candidate.track < 0) return prior;
  const Track& track = tracks[static_cast<size_t>(candidate.track)];
  prior.score = track.score;
  prior.age = track.age;
  prior.moved = track.moved;
  prior.moving = time_s - track.moved_s < options.moving_s;
  prior.certain = time_s < track.certain_until_s;
  prior.lay_s = track.lay_s;
  prior.full_m2 = track.full_m2;
  // The heading in the previous frame is a prior of the heading now.
  const bool recent = !track.facing.empty() && time_s - track.facing_s <= options.facing_s;
  if (track.age < options.min_facing_age || !recent) return prior;
  prior.facing = track.facing;
  const float fresh = options.fresh_facing;
  for (float& share : prior.facing)
    share = (1 - fresh) * share + fresh / static_cast<float>(prior.facing.size());
  return prior;
}

bool IsVerifiedByPose(const Detection& detection) {
  return detection.verifier == Verifier::kForestAndNetwork;
}

bool IsContested(const Detection& detection) { return detection.verifier == Verifier::kSurfaceFit; }

Decision DescribeDetection(const Detection& detection, Rule rule, double needed_score) {
  Decision decision = DescribeRegion(detection.candidate.region, rule);
  decision.classified = true;
  decision.score = detection.evidence.score;
  decision.mean_score = detection.score;
  decision.needed_score = needed_score;
  decision.observations = detection.age;
  return decision;
}

}  // namespace ossa::people
