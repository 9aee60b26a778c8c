#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "recon/fuse/clock_search_internal.h"
#include "recon/fuse/rigid_alignment_internal.h"

namespace ossa::recon {
namespace {

// Constants: by hand.

constexpr size_t kMostMoments = 300;  // compared times per track, evenly spread; for speed
constexpr size_t kMostMinima = 3;     // minima kept per pair of tracks
constexpr double kLeastOverlap_s = 0.5;
constexpr double kLeastShare = 1.0 / 3;  // minimum overlap, share of the shorter track
constexpr double kDoubt_s = 0.5;         // overlap at which the cost is doubled

std::vector<size_t> SpreadMoments(size_t count) {
  const size_t taken = std::min(count, kMostMoments);
  std::vector<size_t> moments(taken);
  for (size_t i = 0; i < taken; ++i) moments[i] = i * count / taken;
  return moments;
}

void AddJoints(const SeenJoints& from, const SeenJoints& to, RigidAlignment& alignment) {
  for (size_t j = 0; j < kJointCount; ++j) {
    const double weight = std::min(from.weight[j], to.weight[j]);
    if (weight > 0.0) alignment.Add(from.position_m[j], to.position_m[j], weight);
  }
}

std::optional<CameraGuess> GuessAt(double offset_s, const JointTrack& a, const JointTrack& b,
                                   const std::vector<size_t>& moments, double least_s) {
  RigidAlignment alignment;
  SeenJoints seen;
  size_t common = 0;
  for (const size_t m : moments) {
    if (!InterpolateJoints(b, a.time_s[m] - offset_s, seen)) continue;
    AddJoints(seen, a.seen[m], alignment);
    ++common;
  }
  const double common_s =
      a.length_s() * static_cast<double>(common) / static_cast<double>(moments.size());
  if (common_s < least_s || !(alignment.weight() > 0.0)) return std::nullopt;
  const RigidAlignment::Result best = alignment.Solve();
  return CameraGuess{best.to_from_from, offset_s,
                     best.mean_square_m2 * (1.0 + kDoubt_s / common_s)};
}

double CostOf(const std::optional<CameraGuess>& guess) {
  return guess ? guess->cost : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<CameraGuess> SearchClock(const JointTrack& of_camera_0, const JointTrack& of_other,
                                     const OffsetGrid& grid) {
  const double shorter_s = std::min(of_camera_0.length_s(), of_other.length_s());
  const double least_s = std::max(kLeastOverlap_s, kLeastShare * shorter_s);
  if (shorter_s < least_s) return {};
  const std::vector<size_t> moments = SpreadMoments(of_camera_0.time_s.size());
  std::vector<std::optional<CameraGuess>> all;
  const auto steps = static_cast<int>(std::floor((grid.high_s - grid.low_s) / grid.step_s));
  for (int i = 0; i <= steps; ++i) {
    all.push_back(GuessAt(grid.low_s + i * grid.step_s, of_camera_0, of_other, moments, least_s));
  }
  std::vector<CameraGuess> minima;
  for (size_t i = 0; i < all.size(); ++i) {
    const double before = i == 0 ? CostOf(std::nullopt) : CostOf(all[i - 1]);
    const double after = i + 1 == all.size() ? CostOf(std::nullopt) : CostOf(all[i + 1]);
    if (all[i] && all[i]->cost <= before && all[i]->cost < after) minima.push_back(*all[i]);
  }
  std::stable_sort(minima.begin(), minima.end(),
                   [](const auto& x, const auto& y) { return x.cost < y.cost; });
  minima.resize(std::min(minima.size(), kMostMinima));
  return minima;
}

}  // namespace ossa::recon
