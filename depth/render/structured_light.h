#pragma once
#include <cstdint>

#include "depth/image/camera.h"
#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

// Constants: measured on real Kinect v1 frames where it says so (`ossa experiment sensor` prints
// both), else chosen by hand at pictures of both.

/// How a structured-light sensor (Kinect v1, Xtion) falls short of a perfect one. It matches a
/// projected pattern in small windows: what it measures is a disparity, in steps, with edges as
/// ragged as its windows, and nothing where the pattern is not seen.
struct StructuredLightOptions {
  double baseline_m = 0.075;
  /// Disparity step in pixels of a 640-pixel-wide image: 1/8 px gives depth steps of
  /// z² / (8 f b) = 2.9e-6 z² mm, the 4-5 mm at 1.2 m and 46 mm at 4 m of real
  /// Kinect v1 frames (`ossa experiment sensor`).
  double disparity_step_px = 0.125;
  /// Standard deviation of the disparity, same pixels: a quarter step. Departure: Khoshelham &
  /// Elberink 2012, sec. 4, have half a step; in the real frames a plane through 5 × 5 pixels
  /// leaves 1.25 mm at 1.1 m and 2.7 mm at 1.9 m, little more than the steps alone.
  double disparity_noise_px = 0.025;
  /// Noise of one matching window is shared by this many pixels each way (640 wide).
  int window_px = 3;  // by hand
  /// Standard deviation of where a window's measure comes from, pixels, and how far neighbours go
  /// together: silhouettes waver by a pixel or two in waves of ten, as in the real frames.
  double lateral_noise_px = 0.9;
  int lateral_cell_px = 6;
  /// Surfaces begin to drop out below this |cos| of incidence and are gone at half of it.
  double grazing_cos = 0.2;    // cosine
  double dropout = 0.0002;     // share of windows that fail anywhere; share
  double edge_dropout = 0.08;  // ... whose neighbourhood has a depth edge; share
  double edge_mixed = 0.03;    // ... that mix near and far instead of choosing; share
  double nearest_m = 0.4;      // nothing is read nearer than this, nor
  double farthest_m = 8.0;     // farther than this
  /// Width of the whole image, pixels, when the camera is a crop of it; 0: it is not.
  int whole_width_px = 0;
};

/// The rendered image as the sensor delivers it. `rendered` must have been made with
/// RenderOptions::projector on: where nothing is lit, nothing is read. Every pixel's noise depends
/// on (seed, pixel) only.
SensorImage SimulateStructuredLight(const RenderedImage& rendered, const Camera& camera,
                                    const StructuredLightOptions& options, uint64_t seed);

}  // namespace ossa::depth
