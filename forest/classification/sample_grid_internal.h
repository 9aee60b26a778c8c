#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

// Constants: chosen by hand.

/// Where a column (row) of pixels lies on a coarser grid.
struct Between {
  int32_t cell = 0;        // that holds it
  int32_t low = 0;         // the nearest cell whose centre is not to the right of (below) it; >= -1
  int32_t eighths = 0;     // of the way from that centre to the next
  bool is_centre = false;  // the pixel nearest to its cell's centre
};

/// Which pixels of an object walk the trees (samples), and whose leaves each pixel takes. Samples
/// lie on a grid, one a cell; pixels on another surface than all samples around them are samples
/// of their own, off the grid.
struct SparsePixels {
  static constexpr int32_t kNone = -1;

  std::vector<int32_t> position;     // of samples: y << 16 | x, box coordinates
  std::vector<int32_t> from;         // a pixel: the number of its sample
  size_t on_grid = 0;                // so many samples are; the others come after them
  ObjectImage grid;                  // cells as pixels: the samples' depths
  std::vector<int32_t> sample;       // of each cell, row-major, or kNone
  std::vector<Between> column, row;  // of each x and y of the box

  int32_t SampleAt(int x, int y) const {  // of a cell, which may lie off the grid
    if (x < 0 || y < 0 || x >= grid.width || y >= grid.height) return kNone;
    return sample[static_cast<size_t>(y) * static_cast<size_t>(grid.width) +
                  static_cast<size_t>(x)];
  }
};

inline constexpr int kSurfaceGap_mm = 50;  // between neighbours: an arm before the trunk

inline bool SameSurface(int a_mm, int b_mm) {
  return a_mm - b_mm <= kSurfaceGap_mm && b_mm - a_mm <= kSurfaceGap_mm;
}

inline constexpr double kMostSparse = 8.0;  // pixels

/// Chooses samples `spacing` pixels apart, from 1 to kMostSparse; at 1 every pixel is a sample.
/// Those on the grid stand tile by tile: neighbours meet the same nodes, and walk together.
SparsePixels ChooseSparse(const ObjectImage& image, std::span<const int32_t> position,
                          double spacing);

}  // namespace ossa::forest
