#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

// Constants: chosen by hand.

/// Position of a pixel column (row) relative to a coarser grid.
struct Between {
  int32_t cell = 0;        // cell that contains it
  int32_t low = 0;         // last cell whose centre is not to the right (below); >= -1
  int32_t eighths = 0;     // eighths of the distance from that centre to the next
  bool is_centre = false;  // nearest pixel to its cell's centre
};

/// The pixels of an object that are classified by the trees (samples), and the sample of each
/// pixel. Samples are on a grid, one per cell; pixels on another surface than all surrounding
/// samples are additional samples off the grid.
struct SparsePixels {
  static constexpr int32_t kNone = -1;

  std::vector<int32_t> position;     // of samples: y << 16 | x, box coordinates
  std::vector<int32_t> from;         // per pixel: index of its sample
  size_t on_grid = 0;                // number of grid samples; the others follow
  ObjectImage grid;                  // depths of the samples, one pixel per cell
  std::vector<int32_t> sample;       // sample of each cell, row-major, or kNone
  std::vector<Between> column, row;  // for each x and y of the box

  int32_t SampleAt(int x, int y) const {  // the cell may be outside the grid
    if (x < 0 || y < 0 || x >= grid.width || y >= grid.height) return kNone;
    return sample[static_cast<size_t>(y) * static_cast<size_t>(grid.width) +
                  static_cast<size_t>(x)];
  }
};

inline constexpr int kSurfaceGap_mm = 50;  // between surfaces, such as an arm in front of the trunk

inline bool SameSurface(int a_mm, int b_mm) {
  return a_mm - b_mm <= kSurfaceGap_mm && b_mm - a_mm <= kSurfaceGap_mm;
}

inline constexpr double kMostSparse = 8.0;  // pixels

/// Chooses samples `spacing` pixels apart, from 1 to kMostSparse; at 1 every pixel is a sample.
/// Grid samples are ordered by tile: neighbours visit the same nodes and are walked together.
SparsePixels ChooseSparse(const ObjectImage& image, std::span<const int32_t> position,
                          double spacing);

}  // namespace ossa::forest
