#include "recon/refine/surface_samples.h"

#include <algorithm>
#include <cmath>

#include "depth/base/cpu_dispatch.h"

namespace ossa::recon {
namespace {

// Constants: chosen by hand; part of every cascade.

constexpr float kMostBehind_mm = 300.0F;
constexpr float kNearer_mm = 30.0F;  // other surfaces nearer by this occlude the joint
constexpr float kNearest_m = 0.2F;   // nearer points are outside the view: beside the sensor

template <typename T>
using OfSamples = std::array<T, kSurfaceSamples>;

// Positions of one tap of each sample on the two grids.
struct Grids {
  OfSamples<float> x_m{}, y_m{};
};

constexpr std::array<Grids, kSampleTaps> MakeGrids() {
  constexpr double kAside[kSampleTaps] = {-0.25, 0.25, -0.25, 0.25};  // of a cell
  constexpr double kDown[kSampleTaps] = {-0.25, -0.25, 0.25, 0.25};
  std::array<Grids, kSampleTaps> grids;
  for (size_t tap = 0; tap < kSampleTaps; ++tap) {
    size_t next = 0;
    for (const double step_m : kSurfaceGridSteps_m) {
      for (int row = 0; row < kSurfaceGrid; ++row) {
        for (int column = 0; column < kSurfaceGrid; ++column, ++next) {
          constexpr int kMiddle = kSurfaceGrid / 2;
          grids[tap].x_m[next] = static_cast<float>((column - kMiddle + kAside[tap]) * step_m);
          grids[tap].y_m[next] = static_cast<float>((row - kMiddle + kDown[tap]) * step_m);
        }
      }
    }
  }
  return grids;
}

constexpr std::array<Grids, kSampleTaps> kGrids = MakeGrids();

// One tap of each sample, seen by the camera.
struct Taps {
  OfSamples<int32_t> pixel{};  // or kOutside
  OfSamples<float> z_mm{};     // along the camera's axis
  OfSamples<float> slant{};    // distance along the ray per metre of z
  OfSamples<int32_t> depth_mm{}, is_person{};
};
constexpr int32_t kOutside = -1;

// Accumulated taps.
struct Sums {
  OfSamples<float> behind_mm{};
  OfSamples<int32_t> surface{}, hidden{};
};

// As std::clamp, whose assertion would prevent vectorisation.
[[gnu::always_inline]] inline float Within(float value, float least, float most) {
  return std::min(std::max(value, least), most);
}

// As depth::Project, vectorised.
OSSA_CPU_DISPATCH void Project(const depth::Camera& camera, const Eigen::Vector3f& joint_m,
                               const Eigen::Matrix3f& camera_from_frame, const Grids& grids,
                               Taps* taps) {
  const float x_m = joint_m.x(), y_m = joint_m.y(), z_m = joint_m.z();
  const float xx = camera_from_frame(0, 0), xy = camera_from_frame(0, 1);
  const float yx = camera_from_frame(1, 0), yy = camera_from_frame(1, 1);
  const float zx = camera_from_frame(2, 0), zy = camera_from_frame(2, 1);
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  const int width = camera.width, height = camera.height;
  const auto right_end = static_cast<float>(width), bottom = static_cast<float>(height);
  for (size_t i = 0; i < kSurfaceSamples; ++i) {
    const float right_m = grids.x_m[i], down_m = grids.y_m[i];
    const float z = z_m + zx * right_m + zy * down_m;
    const float per_z = Within(1.0F / z, 0.0F, 1.0F / kNearest_m);
    const float tangent_x = (x_m + xx * right_m + xy * down_m) * per_z;
    const float tangent_y = (y_m + yx * right_m + yy * down_m) * per_z;
    // Clamped: coordinates far outside the image exceed int.
    const float u = Within(cx - fx * tangent_x + 0.5F, 0.0F, right_end);
    const float v = Within(cy - fy * tangent_y + 0.5F, 0.0F, bottom);
    const auto column = static_cast<int32_t>(u), row = static_cast<int32_t>(v);
    const bool inside =
        (z >= kNearest_m) & (u > 0.0F) & (column < width) & (v > 0.0F) & (row < height);
    taps->pixel[i] = inside ? row * width + column : kOutside;
    taps->z_mm[i] = 1e3F * z;
    taps->slant[i] = std::sqrt(1.0F + tangent_x * tangent_x + tangent_y * tangent_y);
  }
}

// Branch-free, with numbers of one width, so that it vectorises.
OSSA_CPU_DISPATCH void Add(const Taps& taps, Sums* sums) {
  for (size_t i = 0; i < kSurfaceSamples; ++i) {
    const int32_t outside = taps.pixel[i] == kOutside ? 1 : 0;
    const int32_t read = taps.depth_mm[i] != 0 ? 1 : 0;
    const int32_t person = read & (taps.is_person[i] != 0 ? 1 : 0);
    const float behind_mm = (static_cast<float>(taps.depth_mm[i]) - taps.z_mm[i]) * taps.slant[i];
    const int32_t nearer = behind_mm < -kNearer_mm ? 1 : 0;
    const float within_mm = std::min(std::max(behind_mm, -kMostBehind_mm), kMostBehind_mm);
    sums->behind_mm[i] += static_cast<float>(person) * within_mm;
    sums->surface[i] += person;
    sums->hidden[i] += outside | (read & (person ^ 1) & nearer);
  }
}

OSSA_CPU_DISPATCH void Mean(const Sums& sums, OfSamples<SurfaceSample>* samples) {
  for (size_t i = 0; i < kSurfaceSamples; ++i) {
    const int32_t surface = sums.surface[i];
    const float mean_mm = sums.behind_mm[i] / static_cast<float>(std::max(1, surface));
    const auto from_nearest = static_cast<int32_t>(mean_mm + (kMostBehind_mm + 0.5F));
    const int32_t behind_mm = from_nearest - static_cast<int32_t>(kMostBehind_mm);
    (*samples)[i] = {behind_mm, surface, sums.hidden[i]};
  }
}

}  // namespace

OfSamples<SurfaceSample> SurfaceSampler::Around(const Eigen::Vector3d& joint_m) const {
  Taps taps;
  Sums sums;
  const depth::DepthView view = frame_.view();
  for (const Grids& grids : kGrids) {
    Project(frame_.camera, joint_m.cast<float>(), camera_from_frame_, grids, &taps);
    for (size_t i = 0; i < kSurfaceSamples; ++i) {
      const int32_t pixel = taps.pixel[i];
      taps.depth_mm[i] = pixel == kOutside ? 0 : view.at(pixel);
      taps.is_person[i] = pixel == kOutside ? 0 : is_person_[static_cast<size_t>(pixel)];
    }
    Add(taps, &sums);
  }
  OfSamples<SurfaceSample> samples;
  Mean(sums, &samples);
  return samples;
}

}  // namespace ossa::recon
