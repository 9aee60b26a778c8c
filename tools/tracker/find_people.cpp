#include "tools/tracker/find_people_internal.h"

#include <algorithm>
#include <iterator>

#include "tools/tracker/parallel_internal.h"

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

// The same thing at the same place found to be no person before; null if there was none.
Rejection* RejectionOf(const Candidate& candidate, FinderState& state) {
  const auto& cells = candidate.region.cells;
  const auto same = std::find_if(
      state.rejections.begin(), state.rejections.end(), [&](const Rejection& rejection) {
        const size_t larger = std::max(cells.size(), rejection.cells.size());
        return 4 * Common(cells, rejection.cells) > 3 * larger;
      });
  return same == state.rejections.end() ? nullptr : &*same;
}

double Threshold(const Candidate& candidate, const FindOptions& options) {
  return candidate.track >= 0 ? options.known_person : options.new_person;
}

std::vector<Found> LookAt(const Eyes& eyes, const depth::DepthFrame& frame,
                          std::vector<Candidate> candidates, const FindOptions& options) {
  std::vector<Found> looked(candidates.size());
  ParallelFor(candidates.size(), options.threads, [&](size_t i) {
    PerceiveOptions perceive;
    Known known = eyes.known(candidates[i]);
    perceive.context_prior = std::move(known.context_prior);
    perceive.keep_resolution = options.keep_resolution;
    if (candidates[i].track >= 0) perceive.least_score = 0.0;
    looked[i].perception = Perceive(eyes.model, eyes.targets, frame, candidates[i], perceive);
    double& score = looked[i].perception.person_score;
    if (known.person_score)
      score = options.memory * *known.person_score + (1 - options.memory) * score;
    looked[i].candidate = std::move(candidates[i]);
  });
  return looked;
}

bool Accepted(Found& looked, double time_s, const FindOptions& options, FinderState& state) {
  double& score = looked.perception.person_score;
  Rejection* before = RejectionOf(looked.candidate, state);
  if (before != nullptr) {
    constexpr int kMostLooks = 8;
    before->looks = std::min(before->looks + 1, kMostLooks);
    before->mean_score += (score - before->mean_score) / before->looks;
    before->time_s = time_s;
    score = before->mean_score;
  }
  if (score >= Threshold(looked.candidate, options)) return true;
  if (before == nullptr) state.rejections.push_back({looked.candidate.region.cells, time_s, score});
  return false;
}

// A candidate with two heads, cut; empty unless at least two of the pieces are people themselves.
std::vector<Found> CutByHeads(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const depth::SceneOptions& scene_options,
                              const FindOptions& options, const Found& whole) {
  if (whole.perception.heads_m.size() < 2) return {};
  auto cut =
      depth::SplitCandidate(scene, frame, whole.candidate, whole.perception.heads_m, scene_options);
  if (cut.size() < 2) return {};
  std::vector<Found> pieces = LookAt(eyes, frame, std::move(cut), options);
  std::erase_if(pieces, [&](const Found& piece) {
    return piece.perception.person_score < options.new_person;
  });
  if (pieces.size() < 2) pieces.clear();
  return pieces;
}

std::vector<Candidate> WorthLooking(const depth::Scene& scene, double time_s,
                                    const FindOptions& options, FinderState& state) {
  std::erase_if(state.rejections, [&](const Rejection& r) {
    return time_s < r.time_s || time_s - r.time_s >= options.forget_s;
  });
  std::vector<Candidate> candidates;
  for (const Candidate& candidate : scene.candidates) {
    const Rejection* before = candidate.track < 0 ? RejectionOf(candidate, state) : nullptr;
    if (before != nullptr && time_s - before->time_s < options.look_again_s) continue;
    candidates.push_back(candidate);
    if (candidates.size() == options.max_candidates) break;
  }
  return candidates;
}

}  // namespace

std::vector<Found> FindPeople(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const depth::SceneOptions& scene_options,
                              const FindOptions& options, FinderState& state) {
  std::vector<Found> found;
  const auto judge = [&](Found& looked) {
    if (Accepted(looked, frame.time_s, options, state)) found.push_back(std::move(looked));
  };
  auto candidates = WorthLooking(scene, frame.time_s, options, state);
  for (Found& looked : LookAt(eyes, frame, std::move(candidates), options)) {
    std::vector<Found> people = CutByHeads(eyes, frame, scene, scene_options, options, looked);
    if (people.empty()) {
      judge(looked);
    } else {
      std::move(people.begin(), people.end(), std::back_inserter(found));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    const bool known_a = a.candidate.track >= 0, known_b = b.candidate.track >= 0;
    if (known_a != known_b) return known_a;
    return a.perception.person_score > b.perception.person_score;
  });
  if (found.size() > static_cast<size_t>(options.max_users))
    found.resize(static_cast<size_t>(options.max_users));
  return found;
}

}  // namespace ossa::tracker
