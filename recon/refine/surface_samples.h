#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "depth/image/depth_frame.h"

namespace ossa::recon {

// Constants: chosen on validation subjects, see docs/benchmarks/refinement.md; part of every
// cascade.

/// The surface around each joint is sampled on two square grids perpendicular to the line of sight.
inline constexpr int kSurfaceGrid = 9;  // samples a side
inline constexpr std::array<double, 2> kSurfaceGridSteps_m = {0.025, 0.07};
inline constexpr int kSurfaceSamples =
    static_cast<int>(kSurfaceGridSteps_m.size()) * kSurfaceGrid * kSurfaceGrid;
/// Pixels averaged per sample, at the centres of its cell's quarters. A single pixel would be
/// random at silhouettes and noisy.
inline constexpr int kSampleTaps = 4;

/// The content of a grid cell.
class SurfaceSample {
 public:
  SurfaceSample() = default;
  /// `surface` + `hidden` <= kSampleTaps; the rest is background. `behind_mm` within 500.
  SurfaceSample(int behind_mm, int surface, int hidden)
      : bits_(static_cast<uint16_t>((behind_mm + kNought) << 6 | surface << 3 | hidden)) {}

  /// Depth of the person's surface minus that of the joint; 0 if there is none.
  int behind_mm() const { return (bits_ >> 6) - kNought; }
  /// Shares of the cell, [0, 1]: the person's surface; background behind; occluded or outside the
  /// image.
  float surface() const { return Share(bits_ >> 3 & 7); }
  float beside() const { return Share(kSampleTaps - (bits_ >> 3 & 7) - (bits_ & 7)); }
  float hidden() const { return Share(bits_ & 7); }

 private:
  static constexpr int kNought = 512;
  static float Share(int taps) { return static_cast<float>(taps) / kSampleTaps; }

  uint16_t bits_ = kNought << 6;  // packed, because training holds half a million people in memory
};

/// Samples the surface around points of an image.
class SurfaceSampler {
 public:
  /// Borrows both; `is_person` has one element per pixel.
  SurfaceSampler(const depth::DepthFrame& frame, std::span<const uint8_t> is_person,
                 const Eigen::Matrix3d& frame_from_camera)
      : frame_(frame),
        is_person_(is_person),
        camera_from_frame_(frame_from_camera.transpose().cast<float>()) {}

  /// Samples by grid, row and column (x). `joint_m` in camera space.
  std::array<SurfaceSample, kSurfaceSamples> Around(const Eigen::Vector3d& joint_m) const;

 private:
  const depth::DepthFrame& frame_;
  std::span<const uint8_t> is_person_;
  Eigen::Matrix3f camera_from_frame_;
};

}  // namespace ossa::recon
