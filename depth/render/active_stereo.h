#pragma once
#include <cstdint>

#include "depth/image/camera.h"
#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

// Constants: by hand, at what is said of such sensors, where nothing else is said.

/// How an active stereo sensor (RealSense D4xx) falls short of a perfect one. It matches windows of
/// two infrared images: edges are as wide as a window, errors go together over one and are others
/// in the next frame, and what one of the two does not see has no depth.
struct ActiveStereoOptions {
  double baseline_m = 0.055;  // D415 by its data sheet; D435: 50 mm
  /// Standard deviation of the disparity in pixels of a 640-pixel-wide image: 0.08 px of the
  /// sensor's 1280, as its maker's guide to tuning takes it for well textured surfaces. The depth's
  /// is z² / (f b) of it: 6 mm at 2 m for a D415.
  double disparity_noise_px = 0.04;
  double disparity_step_px = 1.0 / 64.0;  // 1/32 px of 1280, by its format; pixels of 640
  /// Cells in which the error goes together: half of its variance in small blobs, half in large.
  double blob_px = 6.0;         // pixels of 640
  double large_blob_px = 20.0;  // pixels of 640
  /// Side of the matched window, pixels of 640: at an edge the near surface grows by up to half of
  /// it, or the two run into each other over it.
  int window_px = 7;
  double smeared = 0.5;        // of edges: run into each other instead of growing; share
  double edge_dropout = 0.15;  // of the pixels within reach of an edge; share
  /// Surfaces begin to drop out below this |cos| of incidence and are gone at half of it.
  double grazing_cos = 0.25;  // cosine
  /// Patches without texture are not matched: this share of a facing surface at 1 m, growing with
  /// z² as the projected pattern fades.
  double dropout_per_m2 = 0.0015;  // share
  double nearest_m = 0.3;          // nothing is read nearer than this, nor
  double farthest_m = 8.0;         // farther than this
};

/// The rendered image as the sensor delivers it, in the left imager's view. `rendered` must have
/// been made with RenderOptions::projector on, at the baseline: what is not lit is not seen by the
/// right imager. `whole` is the camera of the whole image, of which `camera` is a crop: what the
/// right imager does not have in its image is the black band at the left. Every pixel's noise
/// depends on (seed, pixel) only.
SensorImage SimulateActiveStereo(const RenderedImage& rendered, const Camera& camera,
                                 const Camera& whole, const ActiveStereoOptions& options,
                                 uint64_t seed);

}  // namespace ossa::depth
