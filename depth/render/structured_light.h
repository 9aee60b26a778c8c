#pragma once
#include <cstdint>

#include "depth/image/camera.h"
#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

// Constants: measured on real Kinect v1 frames if stated (`ossa experiment sensor` prints both),
// else chosen by hand by comparing images.

/// Error model of a structured-light sensor (Kinect v1, Xtion). It matches a projected pattern in
/// small windows: it measures quantised disparities, with edges as ragged as its windows, and
/// nothing where the pattern is not visible.
struct StructuredLightOptions {
  double baseline_m = 0.075;
  /// Disparity step in pixels of a 640-pixel-wide image: 1/8 px gives depth steps of
  /// z² / (8 f b) = 2.9e-6 z² mm, the 4-5 mm at 1.2 m and 46 mm at 4 m of real
  /// Kinect v1 frames (`ossa experiment sensor`).
  double disparity_step_px = 0.125;
  /// Standard deviation of the disparity, same pixels: a quarter step. Departure: Khoshelham &
  /// Elberink 2012, sec. 4, report half a step; in the real frames the residual of a plane fit over
  /// 5 × 5 pixels is 1.25 mm at 1.1 m and 2.7 mm at 1.9 m, little more than that of quantisation
  /// alone.
  double disparity_noise_px = 0.025;
  /// Size of a matching window with shared noise, pixels of 640.
  int window_px = 3;  // by hand
  /// Standard deviation of the lateral position of a window's measurement, pixels, correlated
  /// between neighbours: silhouettes waver by a pixel or two with a period of ten, as in the real
  /// frames.
  double lateral_noise_px = 0.9;
  int lateral_cell_px = 6;
  /// Surfaces begin to drop out below this |cos| of incidence and are entirely lost at half of it.
  double grazing_cos = 0.2;    // cosine
  double dropout = 0.0002;     // share of failing windows; share
  double edge_dropout = 0.08;  // ... near a depth edge; share
  double edge_mixed = 0.03;    // ... that blend near and far depths; share
  double nearest_m = 0.4;      // nothing is read nearer than this, nor
  double farthest_m = 8.0;     // farther than this
  /// Width of the whole image, pixels, when the camera is a crop of it; 0: it is not.
  int whole_width_px = 0;
};

/// Simulates the sensor. `rendered` must have been made with RenderOptions::projector on: unlit
/// pixels have no reading. The noise of a pixel depends on (seed, pixel) only.
SensorImage SimulateStructuredLight(const RenderedImage& rendered, const Camera& camera,
                                    const StructuredLightOptions& options, uint64_t seed);

}  // namespace ossa::depth
