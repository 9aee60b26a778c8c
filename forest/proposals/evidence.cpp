// Evidence of sampled pixels of an object: surface points with their classes, and the position
// votes of the leaves they reached (Girshick et al. 2011).
#include <algorithm>
#include <cmath>

#include "forest/proposals/modes_internal.h"
#include "forest/runtime_tables_internal.h"

namespace ossa::forest {
namespace {

// Constants: for speed, by hand.

constexpr size_t kSampledPixels = 640;  // more change modes by less than a millimetre

// The context of pixel i: over many pixels, frequencies follow the posterior without randomness.
size_t DrawContext(const std::vector<float>& posterior, size_t i) {
  // Multiples equidistribute in the unit interval; no unit; by definition (sqrt 5 - 1) / 2.
  constexpr double kGolden = 0.6180339887498949;
  double left = static_cast<double>(i) * kGolden;
  left -= std::trunc(left);
  for (size_t k = 0; k < posterior.size(); ++k) {
    left -= static_cast<double>(posterior[k]);
    if (left < 0) return k;
  }
  return posterior.empty() ? 0 : posterior.size() - 1;
}

// The votes of each sampled pixel's leaf, one per target; null if the tree has none. Pixels
// alternate between trees. Two passes: both access memory randomly, and the cache misses within a
// pass overlap.
std::vector<const Vote*> GatherVotes(const ForestModel& model, const Classification& classification,
                                     std::span<const size_t> pixels) {
  const size_t trees = model.data().trees.size();
  const size_t contexts = model.data().context_names.size();
  std::vector<const int32_t*> row(pixels.size());
  for (size_t k = 0; k < pixels.size(); ++k) {
    const auto sample = static_cast<size_t>(classification.sample[pixels[k]]);
    const auto leaf = static_cast<size_t>(classification.leaf[sample * trees + k % trees]);
    row[k] = &model.tables().vote_rows[k % trees][leaf];
    __builtin_prefetch(row[k]);
  }
  std::vector<const Vote*> votes(pixels.size(), nullptr);
  for (size_t k = 0; k < pixels.size(); ++k) {
    if (*row[k] < 0) continue;
    const size_t block =
        static_cast<size_t>(*row[k]) * contexts + DrawContext(classification.context, k + 1);
    votes[k] = model.data().trees[k % trees].votes.data() + block * model.targets().size();
    __builtin_prefetch(votes[k]);
    __builtin_prefetch(votes[k] + model.targets().size() - 1);
  }
  return votes;
}

// Evidence of `count` samples, zero-initialised.
Evidence EmptyEvidence(size_t count, size_t classes, size_t targets) {
  Evidence evidence;
  evidence.count = count;
  const size_t stride = PaddedToLanes(count);
  for (auto* values :
       {&evidence.x_m, &evidence.y_m, &evidence.z_m, &evidence.distance_m, &evidence.area_m2}) {
    values->resize(stride);
  }
  evidence.class_count = static_cast<int>(classes);
  evidence.probability.resize(classes * stride);
  evidence.votes.resize(targets * stride);
  return evidence;
}

}  // namespace

Evidence GatherEvidence(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, const Classification& classification) {
  const size_t pixel_count = classification.pixel.size();
  const size_t step = std::max<size_t>(1, pixel_count / kSampledPixels);
  std::vector<size_t> pixels;
  for (size_t i = step / 2; i < pixel_count; i += step) pixels.push_back(i);
  const std::vector<const Vote*> votes = GatherVotes(model, classification, pixels);
  const auto classes = static_cast<size_t>(classification.class_count);
  const size_t targets = model.targets().size();
  Evidence evidence = EmptyEvidence(pixels.size(), classes, targets);
  if (!classification.context.empty()) {
    evidence.context_certainty =
        *std::max_element(classification.context.begin(), classification.context.end());
  }
  const size_t stride = evidence.stride();
  for (size_t k = 0; k < pixels.size(); ++k) {
    const int u = classification.pixel[pixels[k]] % depth.width;
    const int v = classification.pixel[pixels[k]] / depth.width;
    const Eigen::Vector3d p_m = depth::BackProject(camera, u, v, depth.at(u, v));
    evidence.x_m[k] = static_cast<float>(p_m.x());
    evidence.y_m[k] = static_cast<float>(p_m.y());
    evidence.z_m[k] = static_cast<float>(p_m.z());
    evidence.distance_m[k] = evidence.surface_m(k).norm();
    evidence.area_m2[k] =
        static_cast<float>(static_cast<double>(step) * p_m.z() * p_m.z() / (camera.fx * camera.fy));
    for (size_t c = 0; c < classes; ++c) {
      evidence.probability[c * stride + k] = classification.Probability(pixels[k], c);
    }
    for (size_t t = 0; votes[k] != nullptr && t < targets; ++t) {
      evidence.votes[t * stride + k] = votes[k][t];
    }
  }
  return evidence;
}

}  // namespace ossa::forest
