// Points of a target's density: surface of its classes, pushed back into the body, and position
// votes. All samples are processed by vector code; then the relevant ones are selected.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/lanes.h"
#include "forest/proposals/modes_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand.

constexpr float kReferenceArea_m2 = 0.004F;  // A0: about the visible surface of an elbow
constexpr float kNoVote = -1.0F;             // a weight

// Byte kByte of each vote as signed centimetres.
template <int kByte>
[[gnu::always_inline]] inline void Offset_m(const IntLanes& votes, Lanes* out) {
  constexpr int kAbove = 24 - 8 * kByte;
  *out = __builtin_convertvector(votes << kAbove >> 24, Lanes) * 0.01F;
}

// The weight of each sample's vote; kNoVote if there is none or it is too long.
static_assert(std::endian::native == std::endian::little && sizeof(Vote) == sizeof(int32_t));
OSSA_CPU_DISPATCH void WeighVotes(const Vote* vote, const float* area_m2, size_t count,
                                  float sharpness_m, float longest_m2, float* weight) {
  for (size_t i = 0; i < count; i += kLanes) {
    IntLanes votes;
    std::memcpy(&votes, vote + i, sizeof(votes));
    Lanes x, y, z;
    Offset_m<0>(votes, &x);
    Offset_m<1>(votes, &y);
    Offset_m<2>(votes, &z);
    const IntLanes spread_cm = votes >> 24 & 0xff;
    const Lanes relative = 0.01F * __builtin_convertvector(spread_cm, Lanes) / sharpness_m;
    const Lanes softness = 1.0F + relative * relative;
    Lanes area;
    LoadLanes(area_m2 + i, &area);
    const IntLanes counts = (spread_cm != Vote::kNone) & (x * x + (y * y + z * z) <= longest_m2);
    const Lanes w = counts ? area / (softness * softness) : Lanes{} + kNoVote;
    std::memcpy(weight + i, &w, sizeof(w));
  }
}

OSSA_CPU_DISPATCH void AddRow(const float* row, size_t count, float* sum) {
  for (size_t i = 0; i < count; ++i) sum[i] += row[i];
}

// The largest number whose root is at most `root`: compares squares without taking roots. Negative
// if there is none.
float LargestSquare(float root) {
  if (root < 0.0F) return -1.0F;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  float square = root * root;
  while (std::sqrt(square) > root) square = std::nextafter(square, 0.0F);
  float next = std::nextafter(square, kInfinity);
  for (; std::sqrt(next) <= root; next = std::nextafter(next, kInfinity)) square = next;
  return square;
}

// Sum of the probabilities of the target's classes.
std::vector<float> SumProbabilities(const Evidence& evidence, const ProposalTarget& target) {
  std::vector<float> sum(evidence.stride(), 0.0F);
  for (const uint8_t c : target.classes) {
    AddRow(evidence.probability_of(c), evidence.stride(), sum.data());
  }
  return sum;
}

struct Votes {
  std::vector<float> weight;     // per sample
  std::vector<uint32_t> picked;  // samples with relevant votes
  float total = 0.0F;            // sum of all weights
};

Votes CountVotes(const Evidence& evidence, const ProposalTarget& target, size_t index) {
  Votes votes;
  votes.weight.resize(evidence.stride());
  WeighVotes(evidence.votes_for(index), evidence.area_m2.data(), evidence.stride(),
             target.vote_sharpness_m, LargestSquare(target.vote_radius_m), votes.weight.data());
  size_t voters = 0;
  for (size_t i = 0; i < evidence.count; ++i) {
    votes.total += std::max(votes.weight[i], 0.0F);
    voters += votes.weight[i] >= 0.0F ? 1 : 0;
  }
  if (votes.total <= 0) return votes;
  // Most votes have negligible weight: those below a fifth of the mean are dropped.
  const float mean = votes.total / static_cast<float>(voters);
  votes.picked.resize(evidence.count);
  votes.picked.resize(
      PickAtLeast(0.2F * mean, votes.weight.data(), evidence.count, votes.picked.data()));
  return votes;
}

}  // namespace

TargetPoints GatherPoints(const Evidence& evidence, const ProposalTarget& target,
                          size_t target_index) {
  const std::vector<float> probability = SumProbabilities(evidence, target);
  std::vector<uint32_t> seen(evidence.count);
  seen.resize(
      PickAtLeast(target.probability_threshold, probability.data(), evidence.count, seen.data()));
  const Votes votes = CountVotes(evidence, target, target_index);
  TargetPoints points{WeightedPoints(target.class_weight > 0 ? seen.size() + votes.picked.size()
                                                             : votes.picked.size()),
                      WeightedPoints(seen.size()), votes.total};
  for (const uint32_t i : seen) {
    const float scale = 1.0F + target.push_back_m / evidence.distance_m[i];
    const Eigen::Vector3f inside_m = evidence.surface_m(i) * scale;
    const float weight = probability[i] * evidence.area_m2[i] / kReferenceArea_m2;
    points.surface.Add(inside_m, weight);
    if (target.class_weight > 0) points.points.Add(inside_m, weight * target.class_weight);
  }
  const Vote* vote = evidence.votes_for(target_index);
  for (const uint32_t i : votes.picked) {
    const auto& cm = vote[i].offset_cm;
    points.points.Add(evidence.surface_m(i) + Eigen::Vector3f(cm[0], cm[1], cm[2]) * 0.01F,
                      votes.weight[i] / votes.total);
  }
  return points;
}

}  // namespace ossa::forest
