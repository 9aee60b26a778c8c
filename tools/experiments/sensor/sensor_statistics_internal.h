#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "depth/image/image.h"
#include "tools/experiments/experiment.h"

namespace ossa::tools {

// Constants: bands of distance by hand.

/// Bounds of bands of distance, metres.
inline constexpr std::array kSensorBands_m = {0.5, 1.0, 1.5, 2.0, 3.0, 4.0};
inline constexpr size_t kSensorBandCount = kSensorBands_m.size() - 1;

/// Statistics of one sensor's frames, accumulated frame by frame.
struct SensorStatistics {
  std::array<std::vector<uint16_t>, kSensorBandCount> readings_mm;  // all frames
  std::array<std::vector<double>, kSensorBandCount> residuals_mm;  // of planes through 5 x 5 pixels
  // Widths of runs without reading between a far and a near surface, over what the projector's
  // baseline predicts, by the side of the near surface on which they are in the image.
  std::vector<double> left_shadows, right_shadows;
  int64_t pinholes = 0;  // single pixels without reading inside a surface
  int64_t readings = 0, pixels = 0;
  int64_t edges = 0;    // pixels whose neighbours in the row lie on two surfaces
  int64_t between = 0;  // ... that lie on neither: flying, or smeared
};

/// Adds a frame. `focal_px`: focal length of the camera.
void Gather(const depth::Image<uint16_t>& image, double focal_px, SensorStatistics& statistics);

/// The median difference between successive readings that occur, over the square of the distance,
/// 1e-6 / mm: constant for a sensor that measures disparities in steps.
double StepOverSquare(std::vector<uint16_t> readings_mm);

/// Two decimals; a dash for NaN.
std::string NumberCell(double value);

/// Noise of each simulated sensor at a perpendicular wall, beside published figures.
Table SensorsBeforeWalls(uint64_t seed);

}  // namespace ossa::tools
