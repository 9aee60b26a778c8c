#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "depth/base/perceptron/pose_regression.h"
#include "depth/image/depth_frame.h"

namespace ossa::recon {

// Constants: chosen by hand; part of every pose network.

/// A person is cropped to a square across the line of sight: arms and legs stretched out fit in.
inline constexpr int kCropSide = 96;          // cells
inline constexpr double kCropCell_m = 0.025;  // side of a cell, at the middle's distance
inline constexpr int kCropCells = kCropSide * kCropSide;
/// Each cell is the mean of so many pixels, in the middles of its quarters.
inline constexpr int kCropTaps = 4;
/// Surface is told to lie at most so far before or behind the middle.
inline constexpr double kCropReach_m = 1.2;

/// What a pose network reads of a person: the depth image around them, resampled so that a cell is
/// as wide as any other person's. Axes are a ViewFrame's at the mean of the person's surface.
struct PersonCrop : ViewFrame {
  /// Of each cell, row by row from above, from what a camera sees on the left.
  struct Cell {
    int16_t behind_mm = 0;  // how far beyond the middle the person's surface lies; 0 without any
    uint8_t surface = 0;    // taps, of kCropTaps: the person's surface;
    uint8_t hidden = 0;     // ... something nearer, or outside the image; the rest is beside
  };
  std::vector<Cell> cells;

  /// Nothing where no surface of the person is seen, or only some that no ViewFrame stands at.
  /// `is_person` has as many elements as the image has pixels.
  static std::optional<PersonCrop> Cut(const depth::DepthFrame& frame,
                                       std::span<const uint8_t> is_person);

  /// Of a place in camera space: x and y, metres, where its ray crosses the plane of the cells, and
  /// how far it lies beyond that plane. Precondition: it lies before the camera.
  Eigen::Vector3d Project(const Eigen::Vector3d& place_m) const;
  /// The exact inverse.
  Eigen::Vector3d BackProject(const Eigen::Vector3d& projected_m) const;
};

}  // namespace ossa::recon
