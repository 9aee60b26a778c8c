// Shotton et al. 2011, sec. 3.3: P(c | I, x) = 1/T Σ_t P_t(c | I, x).
// Departure: leaves know the joint distribution of class and context (which way the person faces).
// All the object's pixels first vote on the context; then each pixel reads P(c | leaf, context).
// A single pixel cannot tell a left shoulder seen from behind from a right one seen from the front;
// the whole person can.
#include "forest/classify.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "forest/feature_internal.h"
#include "forest/forest.h"
#include "forest/runtime_internal.h"
#include "forest/smooth_internal.h"

namespace ossa::forest {
namespace {

constexpr float kEvidenceUnit = 1.0F / 256.0F;  // of LeafTables::evidence
constexpr uint32_t kContextUnits = 64;          // the posterior in integer shares, exact sums
constexpr size_t kPixelsPerTask = 2048;

struct MassRows {
  size_t stride = 0;  // of a pixel
  std::vector<uint8_t> mass;
};

struct ActiveContext {
  uint32_t index = 0;
  uint32_t share = 0;  // of kContextUnits
};

std::vector<int32_t> BoxPositions(const ObjectImage& image, int width,
                                  std::span<const int32_t> pixels) {
  std::vector<int32_t> position(pixels.size());
  for (size_t i = 0; i < pixels.size(); ++i) {
    position[i] = ((pixels[i] / width - image.v0) << 16) | (pixels[i] % width - image.u0);
  }
  return position;
}

// Posterior ∝ prior · exp(evidence_scale · mean evidence): the pixels of one object are far from
// independent, so that their mean counts as evidence_scale of them (learned on held-out frames).
std::vector<float> ContextPosterior(const ForestModel& model, const Classification& result,
                                    std::span<const float> prior) {
  const auto contexts = static_cast<size_t>(model.context_count());
  const size_t trees = model.data().trees.size();
  std::vector<int64_t> sum(contexts, 0);
  for (size_t i = 0; i < result.leaf.size(); ++i) {
    const int16_t* evidence = model.tables().leaves[i % trees].evidence.data() +
                              static_cast<size_t>(result.leaf[i]) * contexts;
    for (size_t k = 0; k < contexts; ++k) sum[k] += evidence[k];
  }
  std::vector<float> log_posterior(contexts);
  const auto count = static_cast<float>(std::max<size_t>(result.leaf.size(), 1));
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

std::vector<ActiveContext> ActiveContexts(std::span<const float> posterior) {
  std::vector<ActiveContext> active;
  for (uint32_t k = 0; k < posterior.size(); ++k) {
    const auto share =
        static_cast<uint32_t>(std::lround(posterior[k] * static_cast<float>(kContextUnits)));
    if (share > 0) active.push_back({k, share});
  }
  return active;
}

// Masses of pixels [first, last), of 255, in rows of `stride`; class c stands in column c - 1,
// since class 0 is never given. Integers and one rounding: the same on every path and in every
// order.
void MixLeaves(const ForestModel& model, std::span<const ActiveContext> active,
               const Classification& result, std::array<size_t, 2> range, MassRows* rows) {
  const auto contexts = static_cast<size_t>(model.context_count());
  const size_t trees = model.data().trees.size();
  std::array<uint32_t, 256> sum{};
  for (size_t i = range[0]; i < range[1]; ++i) {
    std::fill_n(sum.begin(), rows->stride + 1, 0U);
    uint32_t total = 0;
    for (size_t t = 0; t < trees; ++t) {
      const LeafTables& tables = model.tables().leaves[t];
      const size_t row = static_cast<size_t>(result.leaf[i * trees + t]) * contexts;
      for (const ActiveContext& context : active) {
        const uint32_t begin = tables.share_begin[row + context.index];
        const uint32_t end = tables.share_begin[row + context.index + 1];
        for (uint32_t s = begin; s < end; ++s) {
          const uint32_t mass = context.share * tables.shares[s].share;
          sum[tables.shares[s].class_index] += mass;
          total += mass;
        }
      }
    }
    const float scale = total > 0 ? 255.0F / static_cast<float>(total) : 0.0F;
    uint8_t* out = rows->mass.data() + i * rows->stride;
    for (size_t c = 0; c < rows->stride; ++c) {
      out[c] =
          static_cast<uint8_t>(static_cast<int32_t>(static_cast<float>(sum[c + 1]) * scale + 0.5F));
    }
  }
}

// Probabilities and labels of pixels [first, last) from smoothed masses.
void Conclude(const std::vector<uint16_t>& smooth, size_t stride, std::array<size_t, 2> range,
              Classification* result) {
  const auto classes = static_cast<size_t>(result->class_count);
  for (size_t i = range[0]; i < range[1]; ++i) {
    const uint16_t* mass = smooth.data() + i * stride;
    uint32_t total = 0;
    for (size_t c = 0; c < stride; ++c) total += mass[c];
    const float scale = total > 0 ? 1.0F / static_cast<float>(total) : 0.0F;
    float* out = result->probability.data() + i * classes;
    for (size_t c = 1; c < classes; ++c) out[c] = static_cast<float>(mass[c - 1]) * scale;
    const auto best = std::max_element(mass, mass + classes - 1);
    result->label[i] = static_cast<uint8_t>(total > 0 ? best - mass + 1 : 0);
  }
}

int SmoothRadius_px(const ObjectImage& image, const depth::Camera& camera,
                    std::span<const int32_t> position, double radius_m) {
  int64_t sum_mm = 0;
  for (const int32_t p : position) sum_mm += image.depth_mm[image.At(p & 0xffff, p >> 16)];
  if (sum_mm == 0) return 0;
  const double mean_m = 1e-3 * static_cast<double>(sum_mm) / static_cast<double>(position.size());
  return static_cast<int>(std::lround(std::min(radius_m * camera.fx / mean_m, 1e6)));
}

template <typename Function>
void ForRanges(size_t count, int threads, const Function& function) {
  if (threads <= 1 || count <= kPixelsPerTask) return function(0, count);
  oneapi::tbb::task_arena arena(threads);
  arena.execute([&] {
    oneapi::tbb::parallel_for(oneapi::tbb::blocked_range<size_t>(0, count, kPixelsPerTask),
                              [&](const auto& range) { function(range.begin(), range.end()); });
  });
}

}  // namespace

Classification Classify(const ForestModel& model, const depth::DepthView& depth,
                        const depth::Camera& camera, std::span<const int32_t> pixels,
                        const ClassifyOptions& options) {
  Classification result;
  result.class_count = model.class_count();
  result.pixel.reserve(pixels.size());
  for (const int32_t pixel : pixels) {  // a pixel without reading has no feature
    if (depth.at(pixel % depth.width, pixel / depth.width) != 0) result.pixel.push_back(pixel);
  }
  const size_t trees = model.data().trees.size();
  const size_t count = result.pixel.size();
  const ObjectImage image = CutOut(depth, camera, result.pixel, model.data().background_mm);
  const std::vector<int32_t> position = BoxPositions(image, depth.width, result.pixel);
  result.leaf.resize(count * trees);
  const auto walk = options.instructions == InstructionSet::kScalar ? WalkScalar : Walk;
  ForRanges(count, options.threads, [&](size_t first, size_t last) {
    for (size_t t = 0; t < trees; ++t) {
      walk({model.data().trees[t].nodes.data(), &image,
            std::span(position).subspan(first, last - first)},
           result.leaf.data() + first * trees + t, trees);
    }
  });
  const bool known = options.context_prior.size() == static_cast<size_t>(model.context_count());
  result.context = ContextPosterior(
      model, result, known ? options.context_prior : std::span(model.data().context_prior));
  const std::vector<ActiveContext> active = ActiveContexts(result.context);
  MassRows rows;
  rows.stride = (static_cast<size_t>(result.class_count) + 14) / 16 * 16;
  rows.mass.resize(count * rows.stride);
  ForRanges(count, options.threads, [&](size_t first, size_t last) {
    MixLeaves(model, active, result, {first, last}, &rows);
  });
  const std::vector<uint16_t> smooth =
      SmoothMasses({&image, position, rows.mass.data(), rows.stride},
                   SmoothRadius_px(image, camera, position, options.smoothing_m));
  result.probability.resize(count * static_cast<size_t>(result.class_count));
  result.label.resize(count);
  ForRanges(count, options.threads, [&](size_t first, size_t last) {
    Conclude(smooth, rows.stride, {first, last}, &result);
  });
  return result;
}

}  // namespace ossa::forest
