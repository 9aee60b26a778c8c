#include "depth/render/structured_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "depth/render/sensor_noise_internal.h"

namespace ossa::depth {
namespace {

// Constants: chosen by hand.

// Neighbours that differ by more than this share of their depth are on different surfaces.
constexpr float kEdgeShare = 0.03F;

enum Stream : uint64_t {
  kPhase,
  kShiftU,
  kShiftV,
  kChance,
  kWindowNoise,
  kPixelNoise,
  kStreamCount
};

/// Values shared by the pixels of a matching window.
struct Window {
  uint64_t chance = 0;
  float noise_px = 0.0F;
};

class Sensor {
 public:
  Sensor(const RenderedImage& rendered, const Camera& camera, const StructuredLightOptions& options,
         uint64_t seed)
      : rendered_(rendered),
        options_(options),
        width_(camera.width),
        height_(camera.height),
        scale_(
            static_cast<float>(options.whole_width_px > 0 ? options.whole_width_px : camera.width) /
            640.0F),
        lateral_px_(static_cast<float>(options.lateral_noise_px) * scale_),
        shift_u_(width_, height_, ComputeCell_px(options, scale_), Hash(seed, kShiftU)),
        shift_v_(width_, height_, ComputeCell_px(options, scale_), Hash(seed, kShiftV)) {
    for (uint64_t stream = 0; stream < kStreamCount; ++stream) seeds_[stream] = Hash(seed, stream);
    // Windows have a fixed size on the sensor: fewer pixels in downscaled images.
    window_ = std::max(1, Rounded(static_cast<float>(options.window_px) * scale_));
    disparity_times_depth_ =
        static_cast<float>(camera.fx / scale_ * options.baseline_m);  // px of 640 × m
  }

  void ReadRowOfWindows(int row, SensorImage& image) const {
    // Each row of windows has another phase.
    const int phase =
        static_cast<int>(Hash(seeds_[kPhase], static_cast<uint64_t>(row)) % 8) % window_;
    for (int u0 = -phase; u0 < width_; u0 += window_) {
      if (!AnythingAround(u0, row * window_)) continue;
      const Window window = WindowAt(u0 + phase, row);
      for (int v = row * window_; v < std::min((row + 1) * window_, height_); ++v) {
        for (int u = std::max(u0, 0); u < std::min(u0 + window_, width_); ++u) {
          Read(u, v, window, image);
        }
      }
    }
  }

  int rows_of_windows() const { return (height_ + window_ - 1) / window_; }

 private:
  static float ComputeCell_px(const StructuredLightOptions& options, float scale) {
    return std::max(1.0F, static_cast<float>(options.lateral_cell_px) * scale);
  }

  Window WindowAt(int u, int row) const {
    const uint64_t place = static_cast<uint64_t>(row) * 65536 + static_cast<uint64_t>(u);
    return {Hash(seeds_[kChance], place), Normal(Hash(seeds_[kWindowNoise], place))};
  }

  /// Whether a surface is within reach of the window's shift; in a mostly empty image few are.
  bool AnythingAround(int u0, int v0) const {
    const int reach = window_ + 1;
    for (const int v : {v0 - reach, v0, v0 + reach}) {
      for (const int u : {u0 - reach, u0, u0 + reach}) {
        const int cu = std::clamp(u, 0, width_ - 1);
        const int cv = std::clamp(v, 0, height_ - 1);
        if (rendered_.depth_m.at(cu, cv) > 0.0F) return true;
      }
    }
    return false;
  }

  /// Measures pixel (u, v) and stores its source pixel; leaves both unset without a reading.
  void Read(int u, int v, const Window& window, SensorImage& image) const {
    const int from_u = std::clamp(u + Rounded(lateral_px_ * shift_u_.At(u, v)), 0, width_ - 1);
    const int from_v = std::clamp(v + Rounded(lateral_px_ * shift_v_.At(u, v)), 0, height_ - 1);
    float depth_m = rendered_.depth_m.at(from_u, from_v);
    if (depth_m <= 0.0F || rendered_.lit.at(from_u, from_v) == 0) return;
    if (DropsOut(from_u, from_v, window.chance)) return;
    const float other_m = AcrossTheEdge(from_u, from_v);
    if (other_m > 0.0F) {
      if (Uniform(window.chance, 0) < static_cast<float>(options_.edge_dropout)) return;
      if (Uniform(window.chance, 1) < static_cast<float>(options_.edge_mixed)) {
        depth_m += Uniform(window.chance, 2) * (other_m - depth_m);
      }
    }
    const uint64_t place = static_cast<uint64_t>(v) * 65536 + static_cast<uint64_t>(u);
    const uint16_t depth_mm = Quantised_mm(depth_m, window.noise_px, place);
    if (depth_mm == 0) return;
    image.depth_mm.at(u, v) = depth_mm;
    image.source.at(u, v) = from_v * width_ + from_u;
  }

  bool DropsOut(int u, int v, uint64_t chance) const {
    const auto limit = static_cast<float>(options_.grazing_cos);
    const float incidence = rendered_.incidence.at(u, v);
    float share = static_cast<float>(options_.dropout);
    if (incidence < limit) share += std::min(1.0F, 2.0F * (limit - incidence) / limit);
    return Uniform(chance, 3) < share;
  }

  /// Depth of a neighbour on another surface, 0 if there is none.
  float AcrossTheEdge(int u, int v) const {
    const float here_m = rendered_.depth_m.at(u, v);
    const int reach = window_ / 2 + 1;
    for (const auto& [du, dv] : {std::pair{-reach, 0}, {reach, 0}, {0, -reach}, {0, reach}}) {
      const int nu = u + du;
      const int nv = v + dv;
      if (nu < 0 || nv < 0 || nu >= width_ || nv >= height_) continue;
      const float there_m = rendered_.depth_m.at(nu, nv);
      if (there_m > 0.0F && std::abs(there_m - here_m) > kEdgeShare * here_m) return there_m;
    }
    return 0.0F;
  }

  uint16_t Quantised_mm(float depth_m, float window_noise, uint64_t pixel) const {
    // Half of the variance is shared by the window, half is independent per pixel.
    const float noise_px = static_cast<float>(options_.disparity_noise_px) * 0.70710678F *
                           (window_noise + Normal(Hash(seeds_[kPixelNoise], pixel)));
    const auto step_px = static_cast<float>(options_.disparity_step_px);
    const float disparity_px =
        step_px * std::floor((disparity_times_depth_ / depth_m + noise_px) / step_px + 0.5F);
    if (disparity_px <= 0.0F) return 0;
    const float measured_m = disparity_times_depth_ / disparity_px;
    if (measured_m < static_cast<float>(options_.nearest_m) ||
        measured_m > static_cast<float>(options_.farthest_m)) {
      return 0;
    }
    return static_cast<uint16_t>(measured_m * 1000.0F + 0.5F);
  }

  const RenderedImage& rendered_;
  const StructuredLightOptions& options_;
  int width_;
  int height_;
  float scale_;
  float lateral_px_;
  WavyNoise shift_u_, shift_v_;
  int window_ = 1;
  float disparity_times_depth_ = 0.0F;
  std::array<uint64_t, kStreamCount> seeds_{};
};

}  // namespace

SensorImage SimulateStructuredLight(const RenderedImage& rendered, const Camera& camera,
                                    const StructuredLightOptions& options, uint64_t seed) {
  const Sensor sensor(rendered, camera, options, seed);
  SensorImage image{{camera.width, camera.height}, {camera.width, camera.height, -1}};
  for (int row = 0; row < sensor.rows_of_windows(); ++row) sensor.ReadRowOfWindows(row, image);
  return image;
}

}  // namespace ossa::depth
