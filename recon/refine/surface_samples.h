#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "depth/image/depth_frame.h"

namespace ossa::recon {

// Constants: chosen on validation subjects, see docs/benchmarks/refinement.md; part of every
// cascade.

/// Around each joint surface is sampled on two square grids across the line of sight.
inline constexpr int kSurfaceGrid = 9;  // samples a side
inline constexpr std::array<double, 2> kSurfaceGridSteps_m = {0.025, 0.07};
inline constexpr int kSurfaceSamples =
    static_cast<int>(kSurfaceGridSteps_m.size()) * kSurfaceGrid * kSurfaceGrid;
/// Each sample is the mean of so many pixels, in the middles of its cell's quarters: which of two
/// neighbours a single one happens to be, at a silhouette, and how far off the sensor has it,
/// chance decides.
inline constexpr int kSampleTaps = 4;

/// What is seen in a cell of a grid.
class SurfaceSample {
 public:
  SurfaceSample() = default;
  /// `surface` + `hidden` <= kSampleTaps; the others are beside. `behind_mm` within 500.
  SurfaceSample(int behind_mm, int surface, int hidden)
      : bits_(static_cast<uint16_t>((behind_mm + kNought) << 6 | surface << 3 | hidden)) {}

  /// How much farther than the joint the person's surface lies there; 0 where none is.
  int behind_mm() const { return (bits_ >> 6) - kNought; }
  /// Shares of the cell, [0, 1]: where the person's surface is; where the sensor looks past it;
  /// where something nearer is, or the image ends.
  float surface() const { return Share(bits_ >> 3 & 7); }
  float beside() const { return Share(kSampleTaps - (bits_ >> 3 & 7) - (bits_ & 7)); }
  float hidden() const { return Share(bits_ & 7); }

 private:
  static constexpr int kNought = 512;
  static float Share(int taps) { return static_cast<float>(taps) / kSampleTaps; }

  uint16_t bits_ = kNought << 6;  // half a million people are held in memory to learn of
};

/// The neighbourhood of places in an image.
class SurfaceSampler {
 public:
  /// Borrows both; `is_person` has as many elements as the image has pixels.
  SurfaceSampler(const depth::DepthFrame& frame, std::span<const uint8_t> is_person,
                 const Eigen::Matrix3d& frame_from_camera)
      : frame_(frame),
        is_person_(is_person),
        camera_from_frame_(frame_from_camera.transpose().cast<float>()) {}

  /// By grid, row and column (x). `joint_m` in camera space.
  std::array<SurfaceSample, kSurfaceSamples> Around(const Eigen::Vector3d& joint_m) const;

 private:
  const depth::DepthFrame& frame_;
  std::span<const uint8_t> is_person_;
  Eigen::Matrix3f camera_from_frame_;
};

}  // namespace ossa::recon
