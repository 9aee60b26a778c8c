#include "depth/render/active_stereo.h"

#include <algorithm>
#include <cmath>

#include "depth/render/sensor_noise_internal.h"

namespace ossa::depth {
namespace {

enum Stream : uint64_t { kBlobs, kLargeBlobs, kEdges, kHoles, kChance };

// Constants: by hand.

// Neighbours whose disparities differ by more (pixels of 640) are on different surfaces.
constexpr float kEdge_px = 1.0F;

/// The result of a matching window.
struct Match {
  float disparity_px = 0.0F;  // in pixels of this image; 0: no match
  int32_t source = -1;
  bool at_edge = false;
};

class Sensor {
 public:
  Sensor(const RenderedImage& rendered, const Camera& camera, const Camera& whole,
         const ActiveStereoOptions& options, uint64_t seed)
      : rendered_(rendered),
        camera_(camera),
        options_(options),
        scale_(static_cast<float>(whole.width) / 640.0F),
        crop_left_px_(static_cast<float>(whole.cx - camera.cx)),
        focal_baseline_(static_cast<float>(camera.fx * options.baseline_m)),
        half_window_(std::max(1, Rounded(static_cast<float>(options.window_px) * scale_ / 2.0F))),
        blobs_(camera.width, camera.height, Cell(options.blob_px), Hash(seed, kBlobs)),
        large_(camera.width, camera.height, Cell(options.large_blob_px), Hash(seed, kLargeBlobs)),
        edges_(camera.width, camera.height, Cell(options.large_blob_px), Hash(seed, kEdges)),
        holes_(camera.width, camera.height, Cell(options.blob_px), Hash(seed, kHoles)),
        chance_seed_(Hash(seed, kChance)) {}

  /// Measures pixel (u, v); leaves it unset without a reading.
  void Read(int u, int v, SensorImage& image) const {
    const Match match = MatchAt(u, v);
    if (match.source < 0) return;
    // Outside the other imager's image.
    if (static_cast<float>(u) + crop_left_px_ < match.disparity_px) return;
    const auto place = static_cast<uint64_t>(v) * 65536 + static_cast<uint64_t>(u);
    if (DropsOut(match, u, v, Hash(chance_seed_, place))) return;
    const float error_px = static_cast<float>(options_.disparity_noise_px) * scale_ * 0.70710678F *
                           (blobs_.At(u, v) + large_.At(u, v));
    const float step_px = static_cast<float>(options_.disparity_step_px) * scale_;
    const float measured_px =
        step_px * std::floor((match.disparity_px + error_px) / step_px + 0.5F);
    if (measured_px <= 0.0F) return;
    const float measured_m = focal_baseline_ / measured_px;
    if (measured_m < static_cast<float>(options_.nearest_m) ||
        measured_m > static_cast<float>(options_.farthest_m)) {
      return;
    }
    image.depth_mm.at(u, v) = static_cast<uint16_t>(measured_m * 1000.0F + 0.5F);
    image.source.at(u, v) = match.source;
  }

 private:
  float Cell(double cell_px) const { return std::max(1.0F, static_cast<float>(cell_px) * scale_); }

  /// Disparity of the surface, pixels; 0 without a surface.
  float Disparity_px(int u, int v) const {
    const float depth_m = rendered_.depth_m.at(u, v);
    return depth_m > 0.0F ? focal_baseline_ / depth_m : 0.0F;
  }

  Match MatchAt(int u, int v) const {
    const float own_px = Disparity_px(u, v);
    Match match{own_px, v * camera_.width + u, false};
    float nearest_px = own_px, sum_px = 0.0F;
    int32_t nearest = match.source;
    int count = 0;
    for (int step = -2; step <= 2; ++step) {
      // Five samples each along the window's row and column.
      for (const bool along_u : {true, false}) {
        const int off = step * half_window_ / 2;
        const int nu = std::clamp(along_u ? u + off : u, 0, camera_.width - 1);
        const int nv = std::clamp(along_u ? v : v + off, 0, camera_.height - 1);
        const float there_px = Disparity_px(nu, nv);
        if (there_px <= 0.0F) continue;
        sum_px += there_px;
        ++count;
        if (there_px > nearest_px) nearest_px = there_px, nearest = nv * camera_.width + nu;
        match.at_edge |= std::abs(there_px - own_px) > kEdge_px * scale_;
      }
    }
    if (count == 0) return {};
    if (!match.at_edge || own_px <= 0.0F)
      return own_px > 0.0F ? match : Grown(nearest_px, nearest, u, v);
    const float mean_px = sum_px / static_cast<float>(count);
    if (!Smears(u, v)) return {nearest_px, nearest, true};
    // Takes the label of the surface nearest to the measurement.
    const bool near_wins = std::abs(nearest_px - mean_px) < std::abs(own_px - mean_px);
    return {mean_px, near_wins ? nearest : match.source, true};
  }

  /// Beside a silhouette without a background: the near surface either grows here or not.
  Match Grown(float nearest_px, int32_t nearest, int u, int v) const {
    if (nearest_px <= 0.0F || Smears(u, v)) return {};
    return {nearest_px, nearest, true};
  }

  bool Smears(int u, int v) const {
    // Approximates the cumulative normal distribution.
    const float share = 1.0F / (1.0F + std::exp(-1.7F * edges_.At(u, v)));
    return share < static_cast<float>(options_.smeared);
  }

  bool DropsOut(const Match& match, int u, int v, uint64_t chance) const {
    const auto source = static_cast<size_t>(match.source);
    if (rendered_.lit.data[source] == 0) return true;
    if (match.at_edge && Uniform(chance, 0) < static_cast<float>(options_.edge_dropout))
      return true;
    const auto limit = static_cast<float>(options_.grazing_cos);
    const float incidence = rendered_.incidence.data[source];
    const float depth_m = focal_baseline_ / match.disparity_px;
    float share = static_cast<float>(options_.dropout_per_m2) * depth_m * depth_m;
    if (incidence < limit) share += std::min(1.0F, 2.0F * (limit - incidence) / limit);
    return 1.0F / (1.0F + std::exp(-1.7F * holes_.At(u, v))) < share;
  }

  const RenderedImage& rendered_;
  const Camera& camera_;
  const ActiveStereoOptions& options_;
  float scale_;  // pixels per pixel of 640
  float crop_left_px_;
  float focal_baseline_;  // pixel metres
  int half_window_;
  WavyNoise blobs_, large_, edges_, holes_;
  uint64_t chance_seed_;
};

}  // namespace

SensorImage SimulateActiveStereo(const RenderedImage& rendered, const Camera& camera,
                                 const Camera& whole, const ActiveStereoOptions& options,
                                 uint64_t seed) {
  const Sensor sensor(rendered, camera, whole, options, seed);
  SensorImage image{{camera.width, camera.height}, {camera.width, camera.height, -1}};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) sensor.Read(u, v, image);
  }
  return image;
}

}  // namespace ossa::depth
