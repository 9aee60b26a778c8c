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

/// A person is cropped to a square perpendicular to the line of sight, large enough for stretched
/// arms and legs.
inline constexpr int kCropSide = 96;          // cells
inline constexpr double kCropCell_m = 0.025;  // side of a cell, at the middle's distance
inline constexpr int kCropCells = kCropSide * kCropSide;
/// Pixels averaged per cell, at the centres of its quarters.
inline constexpr int kCropTaps = 4;
/// Surface depth relative to the middle is clamped to this.
inline constexpr double kCropReach_m = 1.2;

/// Input of a pose network: the depth image around a person, resampled so that all cells have the
/// same metric width. Axes are those of a ViewFrame at the mean of the person's surface.
struct PersonCrop : ViewFrame {
  /// Cells row by row from the top, from the camera's left.
  struct Cell {
    int16_t behind_mm = 0;  // depth of the person's surface minus that of the middle; 0 if none
    uint8_t surface = 0;    // number of taps, of kCropTaps: on the person;
    uint8_t hidden = 0;     // ... occluded or outside the image; the rest is background
  };
  std::vector<Cell> cells;

  /// None if no surface of the person is seen, or no ViewFrame exists for it. `is_person` has one
  /// element per pixel.
  static std::optional<PersonCrop> Cut(const depth::DepthFrame& frame,
                                       std::span<const uint8_t> is_person);

  /// Projects a point in camera space: x and y, metres, where its ray intersects the plane of the
  /// cells, and its depth beyond that plane. Precondition: it is in front of the camera.
  Eigen::Vector3d Project(const Eigen::Vector3d& place_m) const;
  /// The inverse of Project.
  Eigen::Vector3d BackProject(const Eigen::Vector3d& projected_m) const;
};

}  // namespace ossa::recon
