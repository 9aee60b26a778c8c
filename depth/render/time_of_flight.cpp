#include "depth/render/time_of_flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "depth/base/angles.h"
#include "depth/render/sensor_noise_internal.h"

namespace ossa::depth {
namespace {

enum Stream : uint64_t { kPatches, kNoise, kEdges };

/// Amplitude and apparent depth of the returned light.
struct Echo {
  float light = 0.0F;  // 0: no surface
  float depth_m = 0.0F;
};

class Sensor {
 public:
  Sensor(const RenderedImage& rendered, const Camera& camera, const TimeOfFlightOptions& options,
         uint64_t seed)
      : rendered_(rendered),
        camera_(camera),
        options_(options),
        patches_(camera.width, camera.height, ComputePatch_px(camera, options),
                 Hash(seed, kPatches)),
        noise_seed_(Hash(seed, kNoise)),
        edge_seed_(Hash(seed, kEdges)) {}

  /// Measures pixel (u, v); leaves it unset without a reading.
  void Read(int u, int v, SensorImage& image) const {
    const Echo own = EchoAt(u, v);
    if (own.light <= 0.0F) return;
    int32_t source = v * camera_.width + u;
    bool mixed = false;
    const Echo echo = Mixed(own, u, v, source, mixed);
    const auto place = static_cast<uint64_t>(v) * 65536 + static_cast<uint64_t>(u);
    if (mixed && Uniform(Hash(edge_seed_, place), 0) < Float(options_.found_out)) return;
    const float limit =
        Float(options_.least_light) * (1.0F + Float(options_.patchiness) * patches_.At(u, v));
    if (echo.light < limit) return;
    const float measured_m = echo.depth_m + Deviation_m(echo) * Normal(Hash(noise_seed_, place));
    if (measured_m < Float(options_.nearest_m) || measured_m > Float(options_.farthest_m)) return;
    image.depth_mm.at(u, v) = static_cast<uint16_t>(measured_m * 1000.0F + 0.5F);
    image.source.at(u, v) = source;
  }

 private:
  static float Float(double value) { return static_cast<float>(value); }

  static float ComputePatch_px(const Camera& camera, const TimeOfFlightOptions& options) {
    const int whole_px = options.whole_width_px > 0 ? options.whole_width_px : camera.width;
    return std::max(1.0F, Float(options.patch_px) * static_cast<float>(whole_px) / 640.0F);
  }

  bool IsInside(int u, int v) const {
    return u >= 0 && v >= 0 && u < camera_.width && v < camera_.height;
  }

  bool OnAnotherSurface(float here_m, float there_m) const {
    return std::abs(there_m - here_m) > Float(options_.edge_share) * std::min(here_m, there_m);
  }

  /// Echo of the pixel's own surface, including light by way of its neighbours.
  Echo EchoAt(int u, int v) const {
    const float depth_m = rendered_.depth_m.at(u, v);
    if (depth_m <= 0.0F) return {};
    const float x = (static_cast<float>(u) - Float(camera_.cx)) / Float(camera_.fx);
    const float y = (static_cast<float>(v) - Float(camera_.cy)) / Float(camera_.fy);
    if (!IsLit(x, y)) return {};
    const float cosine = 1.0F / std::sqrt(1.0F + x * x + y * y);
    const float reflectance = rendered_.reflectance.data.empty() ? Float(options_.usual_reflectance)
                                                                 : rendered_.reflectance.at(u, v);
    const float light = reflectance * rendered_.incidence.at(u, v) *
                        std::pow(cosine, Float(options_.fall_off)) / (depth_m * depth_m);
    return {light, depth_m - CornerFilling_m(u, v, depth_m)};
  }

  bool IsLit(float x, float y) const {
    constexpr double kEverywhere = 89.0;  // degrees; by hand: its tangent is finite
    if (options_.reach_x_deg > kEverywhere || options_.reach_y_deg > kEverywhere) return true;
    const float a = x / Float(std::tan(options_.reach_x_deg * kDegree));
    const float b = y / Float(std::tan(options_.reach_y_deg * kDegree));
    return a * a + b * b <= 1.0F;
  }

  /// Depth error of concave corners, which appear nearer; 0 elsewhere.
  float CornerFilling_m(int u, int v, float depth_m) const {
    if (options_.corner_filling <= 0.0) return 0.0F;
    const int reach =
        std::max(1, Rounded(Float(options_.corner_reach_m) * Float(camera_.fx) / depth_m));
    float deepest_m = 0.0F;
    for (const auto& [du, dv] :
         {std::pair{reach, 0}, {0, reach}, {reach, reach}, {reach, -reach}}) {
      if (!IsInside(u + du, v + dv) || !IsInside(u - du, v - dv)) continue;
      const float one_m = rendered_.depth_m.at(u + du, v + dv);
      const float other_m = rendered_.depth_m.at(u - du, v - dv);
      if (one_m <= 0.0F || other_m <= 0.0F) continue;
      // Decreases across depth gaps: a surface in front is not a wall of the corner.
      const float most_m = 3.0F * Float(options_.corner_reach_m);
      const float near = std::max(0.0F, 1.0F - std::abs(one_m - depth_m) / most_m) *
                         std::max(0.0F, 1.0F - std::abs(other_m - depth_m) / most_m);
      deepest_m = std::max(deepest_m, near * (depth_m - 0.5F * (one_m + other_m)));
    }
    return Float(options_.corner_filling) * deepest_m;
  }

  /// The pixel's echo, mixed with its neighbours'. If another surface contributes, `mixed` is set,
  /// and `source` is the pixel whose surface is nearest to the measurement.
  Echo Mixed(const Echo& own, int u, int v, int32_t& source, bool& mixed) const {
    constexpr std::array<std::pair<int, int>, 4> kAround = {{{-1, 0}, {1, 0}, {0, -1}, {0, 1}}};
    std::array<Echo, 4> around;
    float light = own.light, sum_m = own.light * own.depth_m;
    for (size_t i = 0; i < kAround.size(); ++i) {
      const int nu = u + kAround[i].first, nv = v + kAround[i].second;
      if (!IsInside(nu, nv)) continue;
      const float there_m = rendered_.depth_m.at(nu, nv);
      if (there_m <= 0.0F || !OnAnotherSurface(rendered_.depth_m.at(u, v), there_m)) continue;
      around[i] = EchoAt(nu, nv);
      if (around[i].light <= 0.0F) continue;
      mixed = true;
      const float part = Float(options_.spread) * around[i].light;
      light += part;
      sum_m += part * around[i].depth_m;
    }
    if (!mixed) return own;
    const Echo echo{own.light, sum_m / light};
    float least_m = std::abs(own.depth_m - echo.depth_m);
    for (size_t i = 0; i < kAround.size(); ++i) {
      const float off_m = std::abs(around[i].depth_m - echo.depth_m);
      if (around[i].light <= 0.0F || off_m >= least_m) continue;
      least_m = off_m;
      source = (v + kAround[i].second) * camera_.width + u + kAround[i].first;
    }
    return echo;
  }

  /// Phase noise increases with decreasing amplitude.
  float Deviation_m(const Echo& echo) const {
    const float phase_m =
        Float(options_.noise_per_m2) * Float(options_.usual_reflectance) / echo.light;
    return std::sqrt(Float(options_.noise_m * options_.noise_m) + phase_m * phase_m);
  }

  const RenderedImage& rendered_;
  const Camera& camera_;
  const TimeOfFlightOptions& options_;
  WavyNoise patches_;
  uint64_t noise_seed_, edge_seed_;
};

}  // namespace

SensorImage SimulateTimeOfFlight(const RenderedImage& rendered, const Camera& camera,
                                 const TimeOfFlightOptions& options, uint64_t seed) {
  const Sensor sensor(rendered, camera, options, seed);
  SensorImage image{{camera.width, camera.height}, {camera.width, camera.height, -1}};
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) sensor.Read(u, v, image);
  }
  return image;
}

}  // namespace ossa::depth
