// Who is taken for a person at once, who after a few looks, and who no longer.
#include <algorithm>
#include <cmath>

#include "tools/tracker/find_people_internal.h"

namespace ossa::tracker {
namespace {

using depth::Candidate;

size_t Common(const std::vector<int>& a, const std::vector<int>& b) {
  size_t common = 0, i = 0;
  for (const int cell : a) {
    while (i < b.size() && b[i] < cell) ++i;
    common += i < b.size() && b[i] == cell ? 1 : 0;
  }
  return common;
}

// What came into view is elsewhere at each look: the nearest that was a step away a moment ago.
Doubt* MovingDoubtOf(const Candidate& candidate, double time_s, FinderState& state) {
  constexpr double kMoment_s = 0.2;
  Doubt* nearest = nullptr;
  float nearest_m = 0.25F;
  for (Doubt& doubt : state.doubts) {
    if (!doubt.arrived || time_s - doubt.time_s > kMoment_s) continue;
    const Eigen::Vector3f off = doubt.mean_m - candidate.region.mean_m;
    const float off_m = std::hypot(off.x(), off.z());  // more or less of it hidden: no height
    if (off_m < nearest_m) nearest_m = off_m, nearest = &doubt;
  }
  return nearest;
}

Doubt FirstDoubt(const Found& looked, double time_s) {
  const depth::Region& region = looked.candidate.region;
  Doubt doubt;
  doubt.cells = region.cells;
  doubt.mean_m = doubt.first_mean_m = region.mean_m;
  doubt.first_m2 = region.area_m2;
  doubt.time_s = time_s;
  doubt.mean_score = looked.perception.person_score;
  doubt.arrived = Arrived(looked.candidate);
  return doubt;
}

// One look more.
void Renew(Doubt& doubt, const Found& looked, double time_s) {
  constexpr int kMostLooks = 8;
  constexpr double kUnbroken_s = 0.12;  // three frames: single ones may be missed
  const depth::Region& region = looked.candidate.region;
  doubt.looks = std::min(doubt.looks + 1, kMostLooks);
  doubt.unbroken = time_s - doubt.time_s < kUnbroken_s ? doubt.unbroken + 1 : 1;
  doubt.mean_score += (looked.perception.person_score - doubt.mean_score) / doubt.looks;
  doubt.time_s = time_s;
  doubt.cells = region.cells;
  doubt.mean_m = region.mean_m;
  doubt.arrived = Arrived(looked.candidate);
  const Eigen::Vector3f way_m = region.mean_m - doubt.first_mean_m;
  doubt.went_m = static_cast<double>(std::hypot(way_m.x(), way_m.z()));
  doubt.moved = doubt.moved || depth::HasMoved(doubt.first_mean_m, doubt.first_m2, region);
  doubt.before_room = doubt.before_room || looked.candidate.arrived_m2 > 0;
}

// Somebody tracked a moment ago goes on by their mean score. Of whom was accepted only just more is
// asked, for a lucky look may have been furniture, and of what never moved; less of what came here.
bool AcceptedAgain(const Found& looked, double time_s, const FindOptions& options,
                   FinderState& state) {
  const double score = looked.perception.person_score;
  // A chair that was put there rests; who bends down to the floor was somebody before.
  const bool little_seen = MayHideMore(looked.candidate) || looked.looks > options.grown_up_looks;
  const bool arrived = looked.moving && little_seen && Arrived(looked.candidate);
  const bool young = looked.looks <= options.young_looks;
  const bool still = looked.looks > options.still_looks && !looked.moved;
  const double needed = arrived ? options.arrived_known
                        : still ? options.still_known
                        : young ? options.young_person
                                : options.known_person;
  if (score >= needed) return true;
  if (still || young) {
    Doubt doubt = FirstDoubt(looked, time_s);
    doubt.fallen = true;
    state.doubts.push_back(std::move(doubt));
  }
  return false;
}

constexpr double kNeverAtOnce = 2;  // no score is

// What a newcomer needs at the first look. A corner of furniture may look like a person once, but
// seldom has the shape of a head, too; what did not come into a known room needs more than one.
double FirstScore(const Candidate& candidate, const depth::Scene& scene,
                  const FindOptions& options) {
  if (candidate.returning) return options.new_person;
  if (scene.fresh) return candidate.has_head ? options.new_person : options.sure_person;
  return Arrived(candidate) ? options.sure_arrived : kNeverAtOnce;
}

// What a newcomer needs as the mean of several looks.
double ProbationScore(const Doubt& doubt, const Candidate& candidate, const FindOptions& options) {
  const bool little_seen = doubt.arrived && MayHideMore(candidate);
  if (little_seen && candidate.alone && doubt.went_m > options.walked_m)
    return options.walked_person;
  if (little_seen && doubt.moved) return options.arrived_person;
  if (!doubt.moved) return options.sure_person;
  // What grows without standing before anything may be uncovered by somebody who passes.
  const bool doubtful = doubt.fallen || !doubt.before_room;
  return doubtful ? options.still_person : options.new_person;
}

// Newcomers are accepted at once in a fresh scene or when there is no doubt, else after a few
// looks.
bool AcceptedNew(Found& looked, const depth::Scene& scene, double time_s,
                 const FindOptions& options, FinderState& state) {
  double& score = looked.perception.person_score;
  Doubt* before = DoubtOf(looked.candidate, time_s, state);
  const bool unprejudiced = before == nullptr || (looked.candidate.returning && !before->fallen);
  if (unprejudiced && score >= FirstScore(looked.candidate, scene, options)) return true;
  if (before == nullptr) {
    state.doubts.push_back(FirstDoubt(looked, time_s));
    return false;
  }
  Renew(*before, looked, time_s);
  const bool often = before->moved ? before->looks >= options.probation_looks
                                   : before->unbroken >= options.standing_looks;
  if (!often || before->mean_score < ProbationScore(*before, looked.candidate, options)) {
    return false;
  }
  score = before->mean_score;
  state.doubts.erase(state.doubts.begin() + (before - state.doubts.data()));
  return true;
}

}  // namespace

bool MayHideMore(const Candidate& candidate) {
  constexpr double kSome = 0.12;  // of the outline: a piece of itself that is cut off hides less
  return candidate.hidden_share > kSome;
}

bool Arrived(const Candidate& candidate) { return candidate.arrived_share > 0.5; }

Doubt* DoubtOf(const Candidate& candidate, double time_s, FinderState& state) {
  const auto& cells = candidate.region.cells;
  const auto same = std::find_if(state.doubts.begin(), state.doubts.end(), [&](const Doubt& doubt) {
    const size_t larger = std::max(cells.size(), doubt.cells.size());
    return 5 * Common(cells, doubt.cells) > 3 * larger;
  });
  if (same != state.doubts.end()) return &*same;
  return Arrived(candidate) ? MovingDoubtOf(candidate, time_s, state) : nullptr;
}

bool Accepted(Found& looked, const depth::Scene& scene, double time_s, const FindOptions& options,
              FinderState& state) {
  return looked.looks > 1 ? AcceptedAgain(looked, time_s, options, state)
                          : AcceptedNew(looked, scene, time_s, options, state);
}

}  // namespace ossa::tracker
