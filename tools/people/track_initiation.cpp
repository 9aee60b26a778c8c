// Who is taken for a person at once, who after a few observations, and who no longer.
#include "tools/people/track_initiation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "recon/filters/frame_steps.h"
#include "tools/people/track_prediction.h"

namespace ossa::people {
namespace {

constexpr double kNeverAtOnce = 2;  // a score, so that none is enough

// Some of it may be out of sight: a lower score is enough. What is seen whole must look like a
// person, however it came: dogs and pushed chairs come, too.
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

// What came into view is elsewhere at each look: the nearest that was a step away a moment ago.
TentativeTrack* FindMovingTentative(const Candidate& candidate, double time_s,
                                    const InitiationOptions& options,
                                    std::vector<TentativeTrack>& tentative) {
  TentativeTrack* nearest = nullptr;
  float nearest_m = options.step_m;
  for (TentativeTrack& track : tentative) {
    if (!track.is_foreground || time_s - track.last_seen_s > options.step_s) continue;
    const Eigen::Vector3f off = track.mean_m - candidate.region.mean_m;
    const float off_m = std::hypot(off.x(), off.z());  // more or less of it hidden: no height
    if (off_m < nearest_m) nearest_m = off_m, nearest = &track;
  }
  return nearest;
}

// The same thing looked at before, at the same place unless it moves; null if there was none.
TentativeTrack* FindTentative(const Candidate& candidate, double time_s,
                              const InitiationOptions& options,
                              std::vector<TentativeTrack>& tentative) {
  const auto& cells = candidate.region.cells;
  const auto same = std::find_if(tentative.begin(), tentative.end(), [&](const auto& track) {
    const size_t larger = std::max(cells.size(), track.cells.size());
    return static_cast<double>(CountCommon(cells, track.cells)) >
           options.same_place * static_cast<double>(larger);
  });
  if (same != tentative.end()) return &*same;
  return IsForeground(candidate) ? FindMovingTentative(candidate, time_s, options, tentative)
                                 : nullptr;
}

TentativeTrack StartTentative(const Detection& detection, double time_s) {
  const Region& region = detection.candidate.region;
  TentativeTrack track;
  track.cells = region.cells;
  track.mean_m = track.first_mean_m = region.mean_m;
  track.first_m2 = region.area_m2;
  track.last_seen_s = time_s;
  track.mean_score = detection.score;
  track.is_foreground = IsForeground(detection.candidate);
  return track;
}

// One look more.
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
  track.was_foreground = track.was_foreground || detection.candidate.foreground_m2 > 0;
}

// Somebody tracked a moment ago goes on by their mean score. Of whom was accepted only just more is
// asked, for a lucky look may have been furniture, and of what never moved; less of what entered.
Decision DecideTracked(const Detection& detection, double time_s, const InitiationOptions& options,
                       std::vector<TentativeTrack>& tentative) {
  const Candidate& candidate = detection.candidate;
  const TrackPrior& prior = detection.prior;
  // A chair that was put there rests; who bends down to the floor was somebody before.
  const bool little_seen = MayBeOccluded(candidate, options) || detection.age > options.mature_age;
  const bool entered = prior.moving && little_seen && IsForeground(candidate);
  const bool early = detection.age <= options.early_age;
  const bool still = detection.age > options.still_age && !prior.moved;
  const double needed = entered ? options.foreground_known
                        : still ? options.still_known
                        : early ? options.early_person
                                : options.known_person;
  if (detection.score >= needed) return DescribeDetection(detection, Rule::kTrackContinued, needed);
  if (still || early) {
    TentativeTrack track = StartTentative(detection, time_s);
    track.was_rejected = true;
    tentative.push_back(std::move(track));
  }
  return DescribeDetection(detection, Rule::kTrackLowScore, needed);
}

struct Requirement {
  Rule rule;
  double score;
};

// What a new person needs at the first look. A corner of furniture may look like a person once, but
// seldom has the shape of a head, too; the pose network tells them apart, where it was asked. What
// did not come into a known room needs more than one look.
Requirement RequireAtFirst(const Detection& detection, bool fresh_scene,
                           const InitiationOptions& options) {
  const Candidate& candidate = detection.candidate;
  if (candidate.may_return) return {Rule::kReturning, options.new_person};
  if (detection.is_joined) return {Rule::kJoinedPieces, options.person_by_pose};
  if (fresh_scene && IsJudgedByPose(detection)) return {Rule::kFreshScene, options.person_by_pose};
  if (fresh_scene)
    return {Rule::kFreshScene, candidate.has_head ? options.new_person : options.sure_person};
  return {Rule::kEntered, IsForeground(candidate) ? options.foreground_first : kNeverAtOnce};
}

// What a new person needs as the mean of several observations.
double RequireInTheMean(const TentativeTrack& track, const Detection& detection,
                        const InitiationOptions& options) {
  const Candidate& candidate = detection.candidate;
  const bool little_seen = track.is_foreground && MayBeOccluded(candidate, options);
  if (little_seen && candidate.isolated && track.walked_m > options.walked_m)
    return options.walked_person;
  if (little_seen && track.moved) return options.foreground_mean;
  if (!track.moved) return IsJudgedByPose(detection) ? options.person_by_pose : options.sure_person;
  // What grows without standing before anything may be uncovered by somebody who passes.
  const bool doubtful = track.was_rejected || !track.was_foreground;
  return doubtful ? options.still_person : options.new_person;
}

Decision DescribeTentative(const Detection& detection, const TentativeTrack& track, Rule rule,
                           double needed) {
  const bool planar = FindOutcome(rule) != Outcome::kConfirmed && detection.candidate.plane;
  Decision decision = DescribeDetection(detection, planar ? Rule::kPlanar : rule, needed);
  decision.observations = track.observations;
  decision.mean_score = track.mean_score;
  return decision;
}

// Pieces that are cut at heads look like people, each.
Decision DecidePiece(const Detection& piece, const InitiationOptions& options) {
  const double needed = IsJudgedByPose(piece) ? options.person_by_pose : options.new_person;
  const bool passes = piece.score >= needed;
  return DescribeDetection(piece, passes ? Rule::kPieceWithHead : Rule::kPieceLowScore, needed);
}

// New people are accepted at once in a fresh scene or when there is no doubt, else after a few
// looks.
Decision DecideNew(bool fresh_scene, double time_s, const InitiationOptions& options,
                   std::vector<TentativeTrack>& tentative, Detection& detection) {
  const Candidate& candidate = detection.candidate;
  TentativeTrack* before = FindTentative(candidate, time_s, options, tentative);
  const bool unprejudiced = before == nullptr || (candidate.may_return && !before->was_rejected);
  const Requirement first = RequireAtFirst(detection, fresh_scene, options);
  if (unprejudiced && detection.score >= first.score)
    return DescribeDetection(detection, first.rule, first.score);
  if (before == nullptr) {
    tentative.push_back(StartTentative(detection, time_s));
    return DescribeTentative(detection, tentative.back(), Rule::kFirstLook, first.score);
  }
  UpdateTentative(detection, time_s, options, *before);
  const bool often = before->moved ? before->observations >= options.tentative_observations
                                   : before->unbroken_observations >= options.standing_observations;
  const double needed = RequireInTheMean(*before, detection, options);
  if (!often) return DescribeTentative(detection, *before, Rule::kFewObservations, needed);
  if (before->mean_score < needed)
    return DescribeTentative(detection, *before, Rule::kLowMeanScore, needed);
  detection.score = before->mean_score;
  const Decision decision =
      DescribeTentative(detection, *before, Rule::kEnoughObservations, needed);
  tentative.erase(tentative.begin() + (before - tentative.data()));
  return decision;
}

// What scored low. All that was rejected in one frame would be due again in one frame, which would
// take long: one a frame is looked at, who waited longest, until they have waited too long.
class Rejected {
 public:
  Rejected(const std::vector<Candidate>& candidates, double time_s, const PeopleOptions& options,
           std::vector<TentativeTrack>& tentative) {
    double longest_s = 0.0;
    for (const Candidate& candidate : candidates) {
      if (candidate.track >= 0 || IsForeground(candidate)) continue;
      const TentativeTrack* before =
          FindTentative(candidate, time_s, options.initiation, tentative);
      if (before == nullptr || before->mean_score >= options.classification.rejected) continue;
      before_.emplace(&candidate, before);
      const double waited_s = time_s - before->last_seen_s;
      if (waited_s >= options.classification.retry_s && waited_s > longest_s) {
        longest_s = waited_s;
        next_ = &candidate;
      }
    }
    latest_s_ = time_s - options.classification.max_retry_s;
  }

  bool Has(const Candidate& candidate) const { return before_.contains(&candidate); }
  /// What is known of a candidate that is not to be looked at now; null of all others.
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

std::vector<Candidate> SelectCandidates(std::vector<Candidate> candidates, bool fresh_scene,
                                        double time_s, const PeopleOptions& options,
                                        std::vector<TentativeTrack>& tentative,
                                        std::vector<Decision>& decided) {
  std::erase_if(tentative, [&](const TentativeTrack& track) {
    return fresh_scene || time_s < track.last_seen_s - recon::FrameSteps::kJitter_s ||
           time_s - track.last_seen_s >= options.initiation.forget_s;
  });
  const Rejected rejected(candidates, time_s, options, tentative);
  std::vector<Candidate> selected;
  for (Candidate& candidate : candidates) {
    if (selected.size() == options.classification.max_candidates) {
      decided.push_back(DescribeRegion(candidate.region, Rule::kCandidateLimit));
      continue;
    }
    if (const TentativeTrack* before = rejected.FindWaiting(candidate)) {
      Decision decision = DescribeRegion(candidate.region, Rule::kRejectedBefore);
      decision.mean_score = before->mean_score;
      decision.observations = before->observations;
      decided.push_back(decision);
      continue;
    }
    candidate.rejected = rejected.Has(candidate);
    selected.push_back(std::move(candidate));
  }
  return selected;
}

bool DecidePerson(bool fresh_scene, double time_s, const InitiationOptions& options,
                  std::vector<TentativeTrack>& tentative, Detection& detection) {
  if (detection.is_piece) {
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
