// Shotton et al. 2011, sec. 3.3: P(c | I, x) = 1/T Σ_t P_t(c | I, x).
// Departure: leaves store the joint distribution of class and context (the person's heading). All
// pixels of an object first vote on the context; then each pixel uses P(c | leaf, context). A
// single pixel cannot distinguish a left shoulder seen from behind from a right one seen from the
// front; the whole person can.
#include "forest/classification/classify.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "depth/base/cpu_dispatch.h"
#include "depth/base/threads.h"
#include "forest/classification/sample_grid_internal.h"
#include "forest/classification/smoothed_masses_internal.h"
#include "forest/forest.h"
#include "forest/runtime_tables_internal.h"
#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {
namespace {

// Constants: chosen by hand; pixel counts for speed.

constexpr float kEvidenceUnit = 1.0F / 256.0F;  // unit of LeafTables::evidence; share
constexpr uint32_t kContextUnits = 64;  // resolution of the posterior in integers, for exact sums
constexpr size_t kPixelsPerTask = 2048;

// Results of the pixels that are classified by the trees.
struct Walked {
  std::vector<int32_t> leaf;  // pixel × tree
  size_t stride = 0;          // row stride of the masses
  std::unique_ptr<uint8_t[]>
      mass;  // probability in 255ths; class c is in column c - 1: class 0 never occurs
};

struct ActiveContext {
  uint32_t index = 0;
  uint32_t share = 0;  // in kContextUnits
};

constexpr size_t kAhead = 24;  // prefetch distance in pixels

// Pixels without a reading have no features.
std::vector<int32_t> PixelsWithReading(const depth::DepthView& depth,
                                       std::span<const int32_t> pixels) {
  std::vector<int32_t> kept(pixels.size());
  size_t count = 0;
  ForRows(pixels, depth.width, [&](int v, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      kept[count] = pixels[i];
      count += depth.at(pixels[i] - v * depth.width, v) != 0 ? 1 : 0;
    }
  });
  kept.resize(count);
  return kept;
}

std::vector<int32_t> BoxPositions(const ObjectImage& image, int width,
                                  std::span<const int32_t> pixels) {
  std::vector<int32_t> position(pixels.size());
  ForRows(pixels, width, [&](int v, size_t first, size_t last) {
    const int32_t shift = (v - image.v0) * kPositionRow - v * width - image.u0;
    for (size_t i = first; i < last; ++i) position[i] = shift + pixels[i];
  });
  return position;
}

OSSA_CPU_DISPATCH void AddTo(const int16_t* __restrict values, size_t count,
                             int32_t* __restrict sum) {
  for (size_t k = 0; k < count; ++k) sum[k] += values[k];
}

// Posterior ∝ prior · exp(evidence_scale · mean evidence): the pixels of an object are far from
// independent, so their mean counts as evidence_scale independent ones (learned on held-out
// frames).
std::vector<float> ContextPosterior(const ForestModel& model, const LeafRows& rows,
                                    std::span<const float> prior) {
  constexpr size_t kPixels = 500;  // as good as all pixels
  const auto contexts = static_cast<size_t>(model.context_count());
  const size_t trees = rows.tables.size();
  const size_t pixels = rows.at.size() / trees;
  const size_t step = std::max<size_t>(1, pixels / kPixels);
  std::vector<int32_t> sum(contexts, 0);  // of at most 2 kPixels per tree: cannot overflow
  size_t walked_leaves = 0;
  const auto evidence_of = [&](size_t i, size_t t) {
    return rows.tables[t].evidence + static_cast<size_t>(rows.at[i * trees + t]) * contexts;
  };
  for (size_t i = 0; i < pixels; i += step) {
    const size_t next = std::min(i + kAhead * step, pixels - 1);
    for (size_t t = 0; t < trees; ++t, ++walked_leaves) {
      __builtin_prefetch(evidence_of(next, t));
      AddTo(evidence_of(i, t), contexts, sum.data());
    }
  }
  std::vector<float> log_posterior(contexts);
  const auto count = static_cast<float>(std::max<size_t>(walked_leaves, 1));
  for (size_t k = 0; k < contexts; ++k) {
    const float mean = static_cast<float>(sum[k]) * kEvidenceUnit / count;
    log_posterior[k] = model.data().evidence_scale * mean + std::log(std::max(prior[k], 1e-4F));
  }
  const float top = *std::max_element(log_posterior.begin(), log_posterior.end());
  float total = 0.0F;
  for (float& value : log_posterior) total += value = std::exp(value - top);
  for (float& value : log_posterior) value /= total;
  return log_posterior;
}

// The contexts to mix: rare ones change no label, and each costs a table row per leaf.
std::vector<ActiveContext> ActiveContexts(std::span<const float> posterior) {
  constexpr uint32_t kLeastShare = 3;
  std::vector<uint32_t> share;
  for (const float p : posterior) {
    share.push_back(static_cast<uint32_t>(std::lround(p * static_cast<float>(kContextUnits))));
  }
  const uint32_t least = std::min(kLeastShare, *std::max_element(share.begin(), share.end()));
  std::vector<ActiveContext> active;
  for (uint32_t k = 0; k < share.size(); ++k) {
    if (share[k] >= least) active.push_back({k, share[k]});
  }
  return active;
}

// Prefetches the table rows of a pixel's leaves, each of which is a cache miss. Always inline: GCC
// 12 considers a function with only prefetches as having no effect, and drops its calls.
[[gnu::always_inline]] inline void FetchRows(const LeafRows& rows, size_t contexts, size_t context,
                                             const int32_t* at) {
  for (const LeafView& tables : rows.tables) {
    __builtin_prefetch(&tables.SharesOf(static_cast<size_t>(*at), context, contexts));
    ++at;
  }
}

// Prefetches the row indices, even earlier.
[[gnu::always_inline]] inline void FetchPlaces(const LeafRows& rows, size_t contexts,
                                               const int32_t* at) {
  for (const LeafView& tables : rows.tables) {
    const auto place = static_cast<size_t>(*at++);
    __builtin_prefetch(tables.first_shares + place);
    __builtin_prefetch(tables.shares_of + place * contexts);
  }
}

// Samples accumulated before their sums are read: reading a value with a wide load directly after
// narrow stores would stall.
constexpr size_t kMixedAtOnce = 32;

// out = sum · 255 / total, rounded; identical on every code path.
OSSA_CPU_DISPATCH void ToMasses(const uint32_t* sum, const uint32_t* total, size_t samples,
                                size_t stride, uint8_t* out) {
  for (size_t i = 0; i < samples; ++i, sum += stride, out += stride) {
    const float scale = total[i] > 0 ? 255.0F / static_cast<float>(total[i]) : 0.0F;
    for (size_t c = 0; c < stride; ++c) {
      out[c] =
          static_cast<uint8_t>(static_cast<int32_t>(static_cast<float>(sum[c]) * scale + 0.5F));
    }
  }
}

// Accumulates the distributions of a sample's leaves; returns the total. Plain pointers, without
// assertions, because it runs for every sample.
uint32_t AddLeaves(const LeafRows& rows, size_t contexts, std::span<const ActiveContext> active,
                   const int32_t* at, uint32_t* sum) {
  uint32_t total = 0;
  for (const LeafView& tables : rows.tables) {
    const auto place = static_cast<size_t>(*at++);
    for (const ActiveContext& context : active) {
      const ShareRow& row = tables.SharesOf(place, context.index, contexts);
      for (size_t s = 0; s < kMostShares; ++s) {
        const uint32_t mass = context.share * row.share[s];
        sum[row.column[s]] += mass;
        total += mass;
      }
    }
  }
  return total;
}

// Class masses of pixels [first, last). Integers and one rounding: the same in any order.
void MixLeaves(const LeafRows& rows, size_t contexts, std::span<const ActiveContext> active,
               std::array<size_t, 2> range, Walked* walked) {
  const size_t trees = rows.tables.size();
  const int32_t* at = rows.at.data();
  std::vector<uint32_t> sum(kMixedAtOnce * walked->stride);
  std::array<uint32_t, kMixedAtOnce> total{};
  for (size_t first = range[0]; first < range[1]; first += kMixedAtOnce) {
    const size_t count = std::min(kMixedAtOnce, range[1] - first);
    std::fill(sum.begin(), sum.end(), 0U);
    for (size_t i = 0; i < count; ++i) {
      const size_t next = std::min(first + i + kAhead, range[1] - 1);
      const size_t after_next = std::min(first + i + 2 * kAhead, range[1] - 1);
      FetchPlaces(rows, contexts, at + after_next * trees);
      for (const ActiveContext& context : active) {
        FetchRows(rows, contexts, context.index, at + next * trees);
      }
      total[i] = AddLeaves(rows, contexts, active, at + (first + i) * trees,
                           sum.data() + i * walked->stride);
    }
    ToMasses(sum.data(), total.data(), count, walked->stride,
             walked->mass.get() + first * walked->stride);
  }
}

OSSA_CPU_DISPATCH void ToScales(const uint16_t* mass, size_t samples, size_t stride, float* scale) {
  for (size_t i = 0; i < samples; ++i, mass += stride) {
    uint32_t total = 0;
    for (size_t c = 0; c < stride; ++c) total += mass[c];
    scale[i] = total > 0 ? 1.0F / static_cast<float>(total) : 0.0F;
  }
}

std::vector<float> ComputeScales(const std::vector<uint16_t>& mass, size_t stride) {
  std::vector<float> scale(mass.size() / stride);
  ToScales(mass.data(), scale.size(), stride, scale.data());
  return scale;
}

// Surface distance between neighbouring pixels at the object's mean depth, metres; 0 without
// pixels.
double Pitch_m(const ObjectImage& image, const depth::Camera& camera, int background_mm,
               size_t pixels) {
  if (pixels == 0) return 0.0;
  // Pixels outside the object read background_mm.
  const int64_t around = static_cast<int64_t>(image.depth_mm.size() - pixels) * background_mm;
  const int64_t all_mm = std::accumulate(image.depth_mm.begin(), image.depth_mm.end(), int64_t{0});
  return 1e-3 * static_cast<double>(all_mm - around) / static_cast<double>(pixels) / camera.fx;
}

std::span<const float> GetContextPrior(const ForestModel& model, const ClassifyOptions& options) {
  const bool known = options.context_prior.size() == static_cast<size_t>(model.context_count());
  return known ? options.context_prior : std::span(model.data().context_prior);
}

int InSteps(double length_m, double step_m) {
  return step_m > 0 ? static_cast<int>(std::min(length_m / step_m, 1e6)) : 0;
}

template <typename Function>
void ForRanges(size_t count, int threads, const Function& function) {
  if (threads <= 1 || count <= kPixelsPerTask) return function(0, count);
  WithThreads(threads, [&] {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<size_t>(0, count, kPixelsPerTask),
                              [&](const auto& range) { function(range.begin(), range.end()); });
  });
}

/// The leaf of each sample in each tree, sample × tree.
std::vector<int32_t> WalkTrees(const ForestModel& model, const ObjectImage& image,
                               std::span<const int32_t> samples, const ClassifyOptions& options) {
  const size_t trees = model.data().trees.size();
  std::vector<int32_t> leaf(samples.size() * trees);
  const auto walk = options.instructions == InstructionSet::kScalar ? WalkScalar : Walk;
  ForRanges(samples.size(), options.threads, [&](size_t first, size_t last) {
    if (first == last) return;  // no pixels
    for (size_t t = 0; t < trees; ++t) {
      walk({&model.tables().trees[t], &image, samples.subspan(first, last - first)},
           leaf.data() + first * trees + t, trees);
    }
  });
  return leaf;
}

}  // namespace

Classification Classify(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, std::span<const int32_t> pixels,
                        const ClassifyOptions& options) {
  Classification result;
  result.class_count = model.class_count();
  result.pixel = PixelsWithReading(depth, pixels);
  const ObjectImage image = CutOut(depth, camera, result.pixel, model.data().background_mm);
  const std::vector<int32_t> position = BoxPositions(image, depth.width, result.pixel);
  const double pitch_m = Pitch_m(image, camera, model.data().background_mm, result.pixel.size());
  const double spacing =
      pitch_m > 0 ? std::clamp(options.sample_spacing_m / pitch_m, 1.0, kMostSparse) : 1.0;
  SparsePixels sparse = ChooseSparse(image, position, spacing);
  Walked walked;
  walked.stride = (static_cast<size_t>(result.class_count) + 14) / 16 * 16;
  const size_t walkers = sparse.position.size();
  walked.leaf = WalkTrees(model, image, sparse.position, options);
  const LeafRows rows = FindRows(model.tables(), walked.leaf);
  const auto contexts = static_cast<size_t>(model.context_count());
  result.context = ContextPosterior(model, rows, GetContextPrior(model, options));
  const std::vector<ActiveContext> active = ActiveContexts(result.context);
  walked.mass = std::make_unique_for_overwrite<uint8_t[]>(walkers * walked.stride);
  ForRanges(walkers, options.threads, [&](size_t first, size_t last) {
    MixLeaves(rows, contexts, active, {first, last}, &walked);
  });
  const double spacing_m = spacing * pitch_m;
  SmoothMasses smooth = Smooth({&sparse, walked.mass.get(), walked.stride},
                               InSteps(options.smoothing_m + spacing_m / 2, spacing_m));
  result.label = LabelPixels(image, position, sparse, smooth);
  result.mass = std::move(smooth.mass);
  result.mass_stride = walked.stride;
  result.mass_scale = ComputeScales(result.mass, walked.stride);
  result.leaf = std::move(walked.leaf);
  result.sample = std::move(sparse.from);
  return result;
}

}  // namespace ossa::forest
