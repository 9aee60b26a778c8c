#include "recon/database/nearest.h"

#include <algorithm>
#include <numeric>

namespace ossa::recon {
namespace {

PostureVector Expanded(const JointWeights& weights) {
  PostureVector out;
  for (size_t i = 0; i < kJointCount; ++i) {
    out.segment<3>(FirstCoordinate(i)).setConstant(static_cast<float>(weights[i]));
  }
  return out;
}

// Departure: the paper searches 2 574 postures by brute force. This search is exact as well, but
// stops early: a posture is dropped once its partial distance, summed in blocks of 12 numbers,
// exceeds the k-th best. Blocks (arm, arm, legs, trunk) are in descending order of variation
// between postures.
constexpr int kBlockSize = 12;
constexpr int kBlocks[5] = {3 * 4, 3 * 8, 3 * 12, 3 * 16, 0};

float Distance(const float* a, const PostureVector& b, const PostureVector& w, float limit) {
  float sum = 0.0F;
  for (const int start : kBlocks) {
    const Eigen::Map<const Eigen::Array<float, kBlockSize, 1>> x(a + start);
    const auto y = b.array().segment<kBlockSize>(start);
    sum += ((x - y).square() * w.array().segment<kBlockSize>(start)).sum();
    if (sum > limit) break;
  }
  return sum;
}

}  // namespace

double WeightedDistance(const PostureVector& a, const PostureVector& b,
                        const JointWeights& weights) {
  return ((a - b).array().square() * Expanded(weights).array()).sum();
}

std::vector<Neighbour> NearestPostures(const PostureDatabase& database, const PostureVector& query,
                                       const JointWeights& weights, int k,
                                       std::span<const int> hints) {
  const PostureVector w = Expanded(weights);
  const int n = database.size();
  const auto wanted = static_cast<size_t>(std::clamp(k, 1, n));
  const float* data = database.postures().data();
  constexpr float kFar = 1e30F;  // square metres, a bound: farther than anything
  float limit = kFar;
  if (hints.size() >= wanted) {
    std::vector<float> d;
    for (const int h : hints)
      d.push_back(Distance(data + size_t(h) * kPostureDims, query, w, kFar));
    std::nth_element(d.begin(), d.begin() + static_cast<ptrdiff_t>(wanted) - 1, d.end());
    limit = d[wanted - 1] * 1.0001F + 1e-9F;
  }
  std::vector<Neighbour> heap;  // max-heap: the farthest one first
  heap.reserve(wanted + 1);
  for (int i = 0; i < n; ++i) {
    const float d = Distance(data + size_t(i) * kPostureDims, query, w, limit);
    if (d > limit) continue;
    heap.push_back({d, i});
    std::push_heap(heap.begin(), heap.end());
    if (heap.size() > wanted) {
      std::pop_heap(heap.begin(), heap.end());
      heap.pop_back();
    }
    if (heap.size() == wanted) limit = std::min(limit, heap.front().distance);
  }
  std::sort_heap(heap.begin(), heap.end());
  return heap;
}

}  // namespace ossa::recon
