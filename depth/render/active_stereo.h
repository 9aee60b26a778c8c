#pragma once
#include <cstdint>

#include "depth/image/camera.h"
#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

// Constants: by hand, from descriptions of such sensors, unless stated otherwise.

/// Error model of an active stereo sensor (RealSense D4xx). It matches windows of two infrared
/// images: edges are as wide as a window, errors are correlated within one and independent between
/// frames, and what only one imager sees has no depth.
struct ActiveStereoOptions {
  double baseline_m = 0.055;  // D415 by its data sheet; D435: 50 mm
  /// Standard deviation of the disparity in pixels of a 640-pixel-wide image: 0.08 px at the
  /// sensor's 1280, the value of the manufacturer's tuning guide for well textured surfaces. The
  /// depth error is z² / (f b) times that: 6 mm at 2 m for a D415.
  double disparity_noise_px = 0.04;
  double disparity_step_px = 1.0 / 64.0;  // 1/32 px of 1280, by its format; pixels of 640
  /// Size of the cells with correlated errors: half of the variance is in small blobs, half in
  /// large ones.
  double blob_px = 6.0;         // pixels of 640
  double large_blob_px = 20.0;  // pixels of 640
  /// Side of the matching window, pixels of 640: at edges the near surface grows by up to half of
  /// it, or both blend over it.
  int window_px = 7;
  double smeared = 0.5;        // share of edges that blend instead of growing; share
  double edge_dropout = 0.15;  // share of pixels near an edge; share
  /// Surfaces begin to drop out below this |cos| of incidence and are entirely lost at half of it.
  double grazing_cos = 0.25;  // cosine
  /// Untextured patches are not matched: this share of a facing surface at 1 m, growing with z² as
  /// the projected pattern fades.
  double dropout_per_m2 = 0.0015;  // share
  double nearest_m = 0.3;          // nothing is read nearer than this, nor
  double farthest_m = 8.0;         // farther than this
};

/// Simulates the sensor, in the left imager's view. `rendered` must have been made with
/// RenderOptions::projector on, at the baseline: unlit pixels are not seen by the right imager.
/// `whole` is the camera of the full image, of which `camera` is a crop: the part outside the right
/// imager's image is the black band at the left. The noise of a pixel depends on (seed, pixel)
/// only.
SensorImage SimulateActiveStereo(const RenderedImage& rendered, const Camera& camera,
                                 const Camera& whole, const ActiveStereoOptions& options,
                                 uint64_t seed);

}  // namespace ossa::depth
