#include "tools/tracker/find_people_internal.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/tracker/choose_posture_internal.h"
#include "tools/tracker/parallel_internal.h"

namespace ossa::tracker {
namespace {

using depth::Candidate;

std::vector<Found> LookAt(const Eyes& eyes, const depth::DepthFrame& frame,
                          std::vector<Candidate> candidates, const FindOptions& options) {
  std::vector<Found> looked(candidates.size());
  ParallelFor(candidates.size(), options.threads, [&](size_t i) {
    PerceiveOptions perceive;
    Known known = eyes.known(candidates[i]);
    perceive.context_prior = std::move(known.context_prior);
    if (candidates[i].track >= 0) perceive.least_score = 0.0;
    looked[i].perception = Perceive(eyes.model, eyes.targets, frame, candidates[i], perceive);
    double& score = looked[i].perception.person_score;
    looked[i].single_score = score;
    looked[i].looks = known.looks + 1;
    looked[i].moved = known.moved;
    looked[i].moving = known.moving;
    looked[i].full_m2 = known.full_m2;
    if (known.person_score) {
      const double weight = std::max(1.0 / looked[i].looks, 1 - options.memory);
      score = *known.person_score + weight * (score - *known.person_score);
    }
    looked[i].candidate = std::move(candidates[i]);
  });
  return looked;
}

// A candidate with two heads, cut; empty unless at least two of the pieces are people themselves.
std::vector<Found> CutByHeads(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const depth::SceneOptions& scene_options,
                              const FindOptions& options, const Found& whole) {
  if (whole.perception.heads_m.size() < 2 || !MayBeTwo(whole, options)) return {};
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
  std::erase_if(state.doubts, [&](const Doubt& doubt) {
    return scene.fresh || time_s < doubt.time_s || time_s - doubt.time_s >= options.forget_s;
  });
  std::vector<Candidate> candidates;
  for (const Candidate& candidate : scene.candidates) {
    const Doubt* before = candidate.track < 0 ? DoubtOf(candidate, time_s, state) : nullptr;
    const bool hopeless =
        before != nullptr && before->mean_score < options.hopeful && !Arrived(candidate);
    if (hopeless && time_s - before->time_s < options.look_again_s) continue;
    candidates.push_back(candidate);
    if (candidates.size() == options.max_candidates) break;
  }
  return candidates;
}

// Two pieces were one person when the whole looks more like a person than either, or
// as much when one is above the other, and has one head. People tracked for long are left as they
// are. Returns the whole, or nothing.
std::optional<Found> Together(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const FindOptions& options, const Found& a,
                              const Found& b) {
  constexpr float kTwoPeople_m2 = 1.1F;
  const bool stacked = Stacked(scene, a, b);
  const bool one_region = a.candidate.origin == b.candidate.origin;
  if (!one_region && !MayBeParts(scene, options, a, b, stacked)) return {};
  if (std::min(a.looks, b.looks) > options.grown_up_looks) return {};
  if (depth::HidesPartOf(scene, a.candidate, b.candidate) ||
      depth::HidesPartOf(scene, b.candidate, a.candidate))
    return {};
  if (a.candidate.region.area_m2 + b.candidate.region.area_m2 > kTwoPeople_m2) return {};
  const bool a_first = a.looks != b.looks ? a.looks > b.looks : a.single_score >= b.single_score;
  const Candidate& first = a_first ? a.candidate : b.candidate;
  const Candidate& second = a_first ? b.candidate : a.candidate;
  auto whole =
      LookAt(eyes, frame, {depth::JoinCandidates(scene, frame, first, second)}, options).at(0);
  // Nobody stands on another: of one above the other the whole need not look better.
  constexpr double kStackedLoss = 0.2;
  const double best = std::max(a.single_score, b.single_score) - (stacked ? kStackedLoss : 0.0);
  if (whole.single_score < best || whole.perception.heads_m.size() > 1) return {};
  return whole;
}

// Joins what belongs together until nothing does. What is no person alone may be part of one.
void JoinParts(const Eyes& eyes, const depth::DepthFrame& frame, const depth::Scene& scene,
               const FindOptions& options, std::vector<Found>& looked) {
  for (size_t i = 0; i < looked.size(); ++i) {
    for (size_t k = i + 1; k < looked.size(); ++k) {
      auto whole = Together(eyes, frame, scene, options, looked[i], looked[k]);
      if (!whole) continue;
      looked[i] = std::move(*whole);
      looked.erase(looked.begin() + static_cast<std::ptrdiff_t>(k));
      k = i;
    }
  }
}

// Bones between the best proposals of neighbouring joints, as far as they hang together from the
// trunk outwards and have about a body's lengths.
std::vector<depth::Bone> BonesOf(const recon::JointArray<int>& targets,
                                 const Perception& perception) {
  using recon::Joint;
  const recon::BoneLengths average_m = AverageBoneLengths();
  recon::JointArray<const forest::Proposal*> best{};
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    const auto& modes = perception.proposals.at(static_cast<size_t>(targets[j]));
    best[j] = modes.empty() ? nullptr : &modes.front();
  }
  recon::JointArray<bool> reached{};
  std::vector<depth::Bone> bones;
  const auto reach = [&](size_t from, size_t to, size_t bone) {
    if (best[from] == nullptr || best[to] == nullptr) return;
    constexpr double kMost = 1.4;  // of an average body's bone
    if ((best[from]->position_m - best[to]->position_m).norm() > kMost * average_m[bone]) return;
    reached[to] = true;
    bones.push_back({best[from]->position_m.cast<float>(), best[to]->position_m.cast<float>()});
  };
  // The shoulders' middle is the surest; from there down to the hips, and parents before children.
  constexpr auto kCentre = recon::Index(Joint::kShoulderCenter);
  constexpr auto kSpine = recon::Index(Joint::kSpine);
  reached[kCentre] = best[kCentre] != nullptr;
  if (reached[kCentre]) reach(kCentre, kSpine, kCentre);
  if (reached[kSpine]) reach(kSpine, 0, kSpine);
  for (size_t j = kCentre + 1; j < recon::kJointCount; ++j) {
    const auto parent = recon::ParentOf(j);
    if (reached[parent]) reach(parent, j, j);
  }
  return bones;
}

// Whether any of it lies so far outside the box around the bones.
bool ReachesBeyond(const std::vector<depth::Bone>& bones, const depth::Region& region,
                   float reach_m) {
  Eigen::Vector3f low_m = region.high_m, high_m = region.low_m;
  for (const depth::Bone& bone : bones) {
    low_m = low_m.cwiseMin(bone.from_m).cwiseMin(bone.to_m);
    high_m = high_m.cwiseMax(bone.from_m).cwiseMax(bone.to_m);
  }
  return ((low_m - region.low_m).array() > reach_m).any() ||
         ((region.high_m - high_m).array() > reach_m).any();
}

}  // namespace

bool Stacked(const depth::Scene& scene, const Found& a, const Found& b) {
  constexpr float kStacked_m = 0.3F;
  const depth::Region &of_a = a.candidate.region, &of_b = b.candidate.region;
  const Eigen::Vector3f apart_m = of_a.mean_m - of_b.mean_m;
  return std::hypot(apart_m.x(), apart_m.z()) < kStacked_m ||
         depth::OneAbove(scene.grid, of_a, of_b);
}

bool MayBeParts(const depth::Scene& scene, const FindOptions& options, const Found& a,
                const Found& b, bool stacked) {
  const auto [less, more] = std::minmax(a.single_score, b.single_score);
  if (stacked && less >= options.new_person) return true;
  return std::max(a.looks, b.looks) <= options.young_looks && more >= options.new_person &&
         depth::Adjoining(scene, a.candidate, b.candidate);
}

bool MayBeTwo(const Found& whole, const FindOptions& options) {
  return whole.looks <= options.grown_up_looks ||
         whole.candidate.region.area_m2 > options.grown_share * whole.full_m2;
}

void TrimToBody(const recon::JointArray<int>& targets, const depth::DepthFrame& frame,
                const depth::Scene& scene, Found& found) {
  constexpr float kReach_m = 0.3F;    // half a stout trunk, and what proposals may be off,
  constexpr float kFar_m = 0.4F;      // ... and more than they ever are
  constexpr size_t kEnoughBones = 6;  // else the forest saw too little of the body to say
  constexpr size_t kAllBones = recon::kJointCount - 1;
  constexpr float kPerson_m2 = 0.9F;  // nobody free of furniture shows more
  const auto bones = BonesOf(targets, found.perception);
  if (bones.size() < kEnoughBones) return;
  const bool large = found.candidate.region.area_m2 >= kPerson_m2;
  const bool whole =
      bones.size() == kAllBones && ReachesBeyond(bones, found.candidate.region, kFar_m);
  if (large || whole)
    depth::KeepNear(scene, frame, bones, large ? kReach_m : kFar_m, found.candidate);
}

std::vector<Found> FindPeople(const Eyes& eyes, const depth::DepthFrame& frame,
                              const depth::Scene& scene, const depth::SceneOptions& scene_options,
                              const FindOptions& options, FinderState& state) {
  std::vector<Found> found;
  auto candidates = WorthLooking(scene, frame.time_s, options, state);
  std::vector<Found> looked = LookAt(eyes, frame, std::move(candidates), options);
  JoinParts(eyes, frame, scene, options, looked);
  for (Found& one : looked) {
    std::vector<Found> people = CutByHeads(eyes, frame, scene, scene_options, options, one);
    if (!people.empty()) {
      std::move(people.begin(), people.end(), std::back_inserter(found));
    } else if (Accepted(one, scene, frame.time_s, options, state)) {
      found.push_back(std::move(one));
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const Found& a, const Found& b) {
    const bool known_a = a.candidate.track >= 0, known_b = b.candidate.track >= 0;
    if (known_a != known_b) return known_a;
    return a.perception.person_score > b.perception.person_score;
  });
  if (found.size() > static_cast<size_t>(options.max_users))
    found.resize(static_cast<size_t>(options.max_users));
  for (Found& one : found) TrimToBody(eyes.targets, frame, scene, one);
  return found;
}

}  // namespace ossa::tracker
