// Track initiation and termination: which candidates are accepted in one frame, which after
// several, and which tracks are rejected.
#include "tools/people/track_initiation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "recon/filters/frame_steps.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

constexpr double kNeverInFirstFrame = 2;  // a score above all, so that none passes

// A partly occluded candidate needs a lower score. A completely visible one must score like a
// person even if it moves, because dogs and pushed chairs move, too.
bool MayBeOccluded(const Candidate& candidate, const InitiationOptions& options) {
  return candidate.occluded_share > options.occluded_share;
}

size_t CountCommon(const std::vector<int>& a, const std::vector<int>& b) {
  size_t common = 0, i = 0;
  for (const int cell : a) {
    while (i < b.size() && b[i] < cell) ++i;
    common += i < b.size() && b[i] == cell ? 1 : 0;
  }
  return common;
}

// Moving foreground: the nearest recent tentative track within a step.
TentativeTrack* FindMovingTentative(const Candidate& candidate, double time_s,
                                    const InitiationOptions& options,
                                    std::vector<TentativeTrack>& tentative) {
  TentativeTrack* nearest = nullptr;
  float nearest_m = options.step_m;
  for (TentativeTrack& track : tentative) {
    if (!track.is_foreground || time_s - track.last_seen_s > options.step_s) continue;
    const Eigen::Vector3f off = track.mean_m - candidate.region.mean_m;
    const float off_m = std::hypot(off.x(), off.z());  // no height: occlusion changes it
    if (off_m < nearest_m) nearest_m = off_m, nearest = &track;
  }
  return nearest;
}

// The tentative track of the same object: at the same place, or nearby if it moves; null for a new
// one. Regions that were joined are another object than each of them: their scores say nothing
// about each other.
TentativeTrack* FindTentative(const Candidate& candidate, bool is_joined, double time_s,
                              const InitiationOptions& options,
                              std::vector<TentativeTrack>& tentative) {
  const auto& cells = candidate.region.cells;
  const auto same = std::find_if(tentative.begin(), tentative.end(), [&](const auto& track) {
    if (track.is_joined != is_joined) return false;
    const size_t larger = std::max(cells.size(), track.cells.size());
    if (std::abs(track.mean_m.z() - candidate.region.mean_m.z()) > options.same_depth_m)
      return false;  // somebody stands before it now
    return static_cast<double>(CountCommon(cells, track.cells)) >
           options.min_common_share * static_cast<double>(larger);
  });
  if (same != tentative.end()) return &*same;
  return IsForeground(candidate) ? FindMovingTentative(candidate, time_s, options, tentative)
                                 : nullptr;
}

// Adds an observation.
void UpdateTentative(const Detection& detection, double time_s, const InitiationOptions& options,
                     TentativeTrack& track) {
  const Region& region = detection.candidate.region;
  track.observations = std::min(track.observations + 1, options.max_observations);
  track.unbroken_observations =
      time_s - track.last_seen_s < options.unbroken_s ? track.unbroken_observations + 1 : 1;
  track.mean_score += (detection.score - track.mean_score) / track.observations;
  track.last_seen_s = time_s;
  track.cells = region.cells;
  track.mean_m = region.mean_m;
  track.is_foreground = IsForeground(detection.candidate);
  const Eigen::Vector3f way_m = region.mean_m - track.first_mean_m;
  track.walked_m = static_cast<double>(std::hypot(way_m.x(), way_m.z()));
  track.moved = track.moved || HasMoved(track.first_mean_m, track.first_m2, region);
  track.was_contested = track.was_contested || IsContested(detection);
  track.was_foreground = track.was_foreground || detection.candidate.foreground_m2 > 0;
}

// The threshold for a track that never moved. Where the pose network contributes it is lower:
// somebody who was accepted by it and sits still stays accepted.
double RequireOfStillTrack(const Detection& detection, const InitiationOptions& options) {
  return IsVerifiedByPose(detection) ? options.weak_by_pose_score : options.still_track_score;
}

// A track continues by its mean score. The threshold is higher for young tracks, which may be
// chance detections of furniture, and for those that never moved; lower for foreground.
Decision DecideTracked(const Detection& detection, double time_s, const InitiationOptions& options,
                       std::vector<TentativeTrack>& tentative) {
  const Candidate& candidate = detection.candidate;
  const TrackPrior& prior = detection.prior;
  // `moving` excludes a chair that was put down. A long-lived track may be a person who bends down.
  const bool little_seen = MayBeOccluded(candidate, options) || detection.age > options.mature_age;
  const bool entered = prior.moving && little_seen && IsForeground(candidate);
  const bool early = detection.age <= options.early_age;
  const bool still = detection.age > options.still_age && !prior.moved;
  const double needed = entered ? options.foreground_track_score
                        : still ? RequireOfStillTrack(detection, options)
                        : early ? options.early_track_score
                                : options.tracked_score;
  if (detection.score >= needed) return DescribeDetection(detection, Rule::kTrackContinued, needed);
  const bool lies = time_s - prior.lay_s < options.rest.lay_s;
  if (prior.certain && (lies || StandsOut(candidate, options.rest)))
    return DescribeDetection(detection, Rule::kTrackRests, needed);
  if (still || early) {
    TentativeTrack track = StartTentative(detection, time_s);
    track.was_rejected = true;
    tentative.push_back(std::move(track));
  }
  return DescribeDetection(detection, Rule::kTrackLowScore, needed);
}

// The threshold for a new person where the pose network contributes. A strip of wall under the
// image's upper border resembles a body whose head is outside.
double RequireByPose(const Detection& detection, const InitiationOptions& options) {
  const Candidate& candidate = detection.candidate;
  const bool cut = candidate.at_top && candidate.region.mean_m.z() > options.cut_beyond_m;
  return cut ? options.cut_by_pose_score : options.person_by_pose_score;
}

struct Requirement {
  Rule rule;
  double score;
};

// The threshold for a new person in a single frame. Furniture may score high once, but seldom has
// the shape of a head as well; the pose network separates them where it was applied. Outside fresh
// scenes only foreground and returning people are accepted in one frame.
Requirement RequireInFirstFrame(const Detection& detection, bool fresh_scene,
                                const InitiationOptions& options) {
  const Candidate& candidate = detection.candidate;
  if (!candidate.may_return_as.empty()) return {Rule::kReturning, options.new_person_score};
  if (fresh_scene && detection.is_joined)
    return {Rule::kJoinedPieces, options.person_by_pose_score};
  if (fresh_scene && IsVerifiedByPose(detection))
    return {Rule::kFreshScene, RequireByPose(detection, options)};
  if (fresh_scene)
    return {Rule::kFreshScene,
            candidate.has_head ? options.new_person_score : options.confident_score};
  // Beside a tracked person it may be their hand or what it holds, for a moment.
  const bool may_enter = IsForeground(candidate) && candidate.isolated;
  return {Rule::kEntered, may_enter ? options.foreground_first_score : kNeverInFirstFrame};
}

// The threshold for a new person on the mean of several observations.
double RequireOnAverage(const TentativeTrack& track, const Detection& detection,
                        const InitiationOptions& options) {
  const Candidate& candidate = detection.candidate;
  const bool little_seen = track.is_foreground && MayBeOccluded(candidate, options);
  if (little_seen && candidate.isolated && track.walked_m > options.walked_m)
    return options.walked_score;
  if (little_seen && track.moved) return options.foreground_mean_score;
  // A surface that grows without being foreground may be uncovered by a person who passes.
  const bool doubtful = track.was_rejected || !track.was_foreground;
  // Contested observations have the forest's score: the mean is no longer one by the network.
  if (track.was_contested && (!track.moved || doubtful)) return options.confident_score;
  if (!track.moved)
    return IsVerifiedByPose(detection) ? RequireByPose(detection, options)
                                       : options.confident_score;
  return doubtful ? options.doubtful_mean_score : options.new_person_score;
}

Decision DescribeTentative(const Detection& detection, const TentativeTrack& track, Rule rule,
                           double needed) {
  const bool planar = FindOutcome(rule) != Outcome::kConfirmed && detection.candidate.plane;
  Decision decision = DescribeDetection(detection, planar ? Rule::kPlanar : rule, needed);
  decision.observations = track.observations;
  decision.mean_score = track.mean_score;
  return decision;
}

// Whether a segment around a head may be accepted in one frame. One that is cut off somebody
// tracked may be a thing beside them: where the pose network was run, both must be confident.
bool MayPassAsPiece(const Detection& piece, const InitiationOptions& options) {
  if (!piece.is_piece) return false;
  if (!piece.is_cut_off || piece.verifier == Verifier::kForest) return true;
  return IsVerifiedByPose(piece) && piece.score >= options.confident_score;
}

// Segments around heads must each score like a person.
Decision DecidePiece(const Detection& piece, const InitiationOptions& options) {
  const double needed =
      IsVerifiedByPose(piece) ? RequireByPose(piece, options) : options.new_person_score;
  const bool passes = piece.score >= needed;
  return DescribeDetection(piece, passes ? Rule::kPieceWithHead : Rule::kPieceLowScore, needed);
}

// New people are accepted in one frame if the scene is fresh or the score is high, else after
// several.
Decision DecideNew(bool fresh_scene, double time_s, const InitiationOptions& options,
                   std::vector<TentativeTrack>& tentative, Detection& detection) {
  const Candidate& candidate = detection.candidate;
  TentativeTrack* before =
      FindTentative(candidate, detection.is_joined, time_s, options, tentative);
  const bool may_pass_at_once =
      before == nullptr || (!candidate.may_return_as.empty() && !before->was_rejected);
  const Requirement first = RequireInFirstFrame(detection, fresh_scene, options);
  if (may_pass_at_once && detection.score >= first.score)
    return DescribeDetection(detection, first.rule, first.score);
  if (before == nullptr) {
    tentative.push_back(StartTentative(detection, time_s));
    return DescribeTentative(detection, tentative.back(), Rule::kFirstLook, first.score);
  }
  UpdateTentative(detection, time_s, options, *before);
  const bool enough = before->moved
                          ? before->observations >= options.tentative_observations
                          : before->unbroken_observations >= options.standing_observations;
  const double needed = RequireOnAverage(*before, detection, options);
  if (!enough) return DescribeTentative(detection, *before, Rule::kFewObservations, needed);
  if (before->mean_score < needed)
    return DescribeTentative(detection, *before, Rule::kLowMeanScore, needed);
  detection.score = before->mean_score;
  detection.was_withdrawn = before->was_withdrawn;
  const Decision decision =
      DescribeTentative(detection, *before, Rule::kEnoughObservations, needed);
  tentative.erase(tentative.begin() + (before - tentative.data()));
  return decision;
}

// Whether an earlier observation with the score of a person is a part of this candidate now: with
// the furniture that they touch one connected region, in this frame and not in that.
bool HoldsLikelyPerson(const Candidate& candidate, const InitiationOptions& options,
                       const std::vector<TentativeTrack>& tentative) {
  const auto& cells = candidate.region.cells;
  return candidate.track < 0 && std::ranges::any_of(tentative, [&](const TentativeTrack& track) {
           const auto size = static_cast<double>(track.cells.size());
           if (track.mean_score < options.likely_score ||
               size > options.min_common_share * static_cast<double>(cells.size()))
             return false;
           return static_cast<double>(CountCommon(cells, track.cells)) >
                  options.likely_share * size;
         });
}

// Candidates with a low score, which are not classified in every frame. To spread the cost, one is
// due per frame, the one that waited longest, and those that waited for max_retry_s. Where a lost
// track is expected there is no wait: who comes out from behind somebody scores higher every frame.
class RetrySchedule {
 public:
  RetrySchedule(const std::vector<Candidate>& candidates, double time_s,
                const PeopleOptions& options, std::vector<TentativeTrack>& tentative) {
    double longest_s = 0.0;
    for (const Candidate& candidate : candidates) {
      if (candidate.track >= 0 || IsForeground(candidate) || candidate.holds_likely_person)
        continue;
      const TentativeTrack* before =
          FindTentative(candidate, false, time_s, options.initiation, tentative);
      if (before == nullptr || before->mean_score >= options.classification.rejected_score)
        continue;
      before_.emplace(&candidate, before);
      const double waited_s = time_s - before->last_seen_s;
      const double least_s = candidate.may_return_as.empty() ? options.classification.retry_s : 0.0;
      if (waited_s >= least_s && waited_s > longest_s) {
        longest_s = waited_s;
        next_ = &candidate;
      }
    }
    latest_s_ = time_s - options.classification.max_retry_s;
  }

  bool Has(const Candidate& candidate) const { return before_.contains(&candidate); }
  /// The tentative track of a candidate that is not due; null for all others.
  const TentativeTrack* FindWaiting(const Candidate& candidate) const {
    const auto found = before_.find(&candidate);
    const bool is_due =
        found == before_.end() || &candidate == next_ || found->second->last_seen_s <= latest_s_;
    return is_due ? nullptr : found->second;
  }

 private:
  std::map<const Candidate*, const TentativeTrack*> before_;
  const Candidate* next_ = nullptr;
  double latest_s_ = 0.0;
};

}  // namespace

TentativeTrack StartTentative(const Detection& detection, double time_s) {
  const Region& region = detection.candidate.region;
  TentativeTrack track;
  track.cells = region.cells;
  track.mean_m = track.first_mean_m = region.mean_m;
  track.first_m2 = region.area_m2;
  track.last_seen_s = time_s;
  track.mean_score = detection.score;
  track.is_foreground = IsForeground(detection.candidate);
  track.was_contested = IsContested(detection);
  track.is_joined = detection.is_joined;
  return track;
}

std::vector<Candidate> SelectCandidates(std::vector<Candidate> candidates, bool fresh_scene,
                                        double time_s, const PeopleOptions& options,
                                        std::vector<TentativeTrack>& tentative,
                                        std::vector<Decision>& decided) {
  std::erase_if(tentative, [&](const TentativeTrack& track) {
    return fresh_scene || time_s < track.last_seen_s - recon::FrameSteps::kJitter_s ||
           time_s - track.last_seen_s >= options.initiation.forget_s;
  });
  for (Candidate& candidate : candidates)
    candidate.holds_likely_person = HoldsLikelyPerson(candidate, options.initiation, tentative);
  const RetrySchedule schedule(candidates, time_s, options, tentative);
  std::vector<Candidate> selected;
  for (Candidate& candidate : candidates) {
    if (selected.size() == options.classification.max_candidates) {
      decided.push_back(DescribeRegion(candidate.region, Rule::kCandidateLimit));
      continue;
    }
    if (const TentativeTrack* before = schedule.FindWaiting(candidate)) {
      Decision decision = DescribeRegion(candidate.region, Rule::kRejectedBefore);
      decision.mean_score = before->mean_score;
      decision.observations = before->observations;
      decided.push_back(decision);
      continue;
    }
    candidate.recently_rejected = schedule.Has(candidate);
    selected.push_back(std::move(candidate));
  }
  return selected;
}

void MarkLikelyPeople(const std::vector<TentativeTrack>& tentative,
                      const InitiationOptions& options, std::vector<uint8_t>& marked) {
  for (const TentativeTrack& track : tentative) {
    if (track.observations < 2 || track.mean_score < options.likely_score) continue;
    for (const int cell : track.cells) marked[static_cast<size_t>(cell)] = 1;
  }
}

double RequireOfPiece(const Detection& piece, bool one_so_far, const InitiationOptions& options) {
  return one_so_far && piece.candidate.track < 0 ? options.confident_score
                                                 : options.new_person_score;
}

bool DecidePerson(bool fresh_scene, double time_s, const InitiationOptions& options,
                  std::vector<TentativeTrack>& tentative, Detection& detection) {
  if (MayPassAsPiece(detection, options)) {
    detection.decision = DecidePiece(detection, options);
  } else if (detection.age > 1) {
    detection.decision = DecideTracked(detection, time_s, options, tentative);
  } else {
    detection.decision = DecideNew(fresh_scene, time_s, options, tentative, detection);
  }
  return FindOutcome(detection.decision.rule) == Outcome::kConfirmed;
}

std::vector<Detection> SelectPeople(std::vector<Detection> detections, bool fresh_scene,
                                    double time_s, const InitiationOptions& options,
                                    std::vector<TentativeTrack>& tentative,
                                    std::vector<Decision>& decided) {
  std::vector<Detection> people;
  for (Detection& detection : detections) {
    if (DecidePerson(fresh_scene, time_s, options, tentative, detection)) {
      people.push_back(std::move(detection));
    } else {
      decided.push_back(detection.decision);
    }
  }
  std::stable_sort(people.begin(), people.end(), [](const Detection& a, const Detection& b) {
    const bool known_a = a.candidate.track >= 0, known_b = b.candidate.track >= 0;
    return known_a != known_b ? known_a : a.score > b.score;
  });
  while (people.size() > static_cast<size_t>(options.max_users)) {
    Decision& decision = people.back().decision;
    decision.rule = Rule::kUserLimit;
    decided.push_back(decision);
    people.pop_back();
  }
  return people;
}

}  // namespace ossa::people
