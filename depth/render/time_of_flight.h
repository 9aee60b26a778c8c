#pragma once
#include <cstdint>

#include "depth/image/camera.h"
#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

// Constants: of a Kinect v2, from the cited literature; otherwise by hand.

/// Error model of a time-of-flight sensor (Kinect v2, Azure Kinect, Femto). It measures the phase
/// of the returned light: less light means more noise, down to no reading; light from two surfaces
/// in one pixel gives a distance between them.
struct TimeOfFlightOptions {
  /// Standard deviation of the depth of a bright, facing surface: the root of the sum of squares of
  /// noise_m and noise_per_m2 z². 1.2 mm, 1.6 mm, 2.5 mm, 4.2 mm at 1, 2, 3, 4 m, within 0.3 mm of
  /// 1.5 - 0.5 z + 0.3 z² mm, Fankhauser et al. 2015, for a Kinect v2.
  double noise_m = 0.0012;
  double noise_per_m2 = 0.00025;  // 1/m, of z²
  /// Default reflectance, without RenderedImage::reflectance.
  double usual_reflectance = 0.6;  // share
  /// A pixel also receives light from this share of its neighbours' area on each side, which gives
  /// depths between two surfaces at their edge (flying pixels), weighted by brightness.
  double spread = 0.35;  // share
  /// Share of mixed pixels that the sensor detects and leaves without a reading.
  double found_out = 0.6;  // share
  /// Neighbours that differ by more than this share of their depth are on different surfaces.
  double edge_share = 0.03;  // share
  /// Multipath: concave corners are measured too near, by up to this share of their depth behind
  /// the surrounding surface, within this reach, decreasing with distance.
  double corner_filling = 0.6;  // share
  double corner_reach_m = 0.06;
  /// Illumination falls off from the optical axis with this power of the cosine. Kinect v2: by
  /// hand, so that image corners have a third of the light of the centre.
  double fall_off = 4.0;  // exponent
  /// Brightness limit of a reading: reflectance times |cos| of incidence times fall-off over z² /
  /// m², no unit. By hand: dark cloth, 0.05, begins to fail at 3 m, and the floor is measured up to
  /// 4.5 m.
  double least_light = 0.004;  // share
  /// Standard deviation of that limit between patches of about this many pixels of a 640-pixel-wide
  /// image: dark surfaces are lost in contiguous holes, not pixel by pixel.
  double patchiness = 0.25;  // share
  double patch_px = 7.0;
  /// Illuminated field: half angles from the optical axis, degrees. Outside this ellipse there is
  /// no reading. 90 and more: unlimited.
  double reach_x_deg = 90.0;
  double reach_y_deg = 90.0;
  double nearest_m = 0.4;   // nothing is read nearer than this, nor
  double farthest_m = 6.0;  // farther than this
  /// Width of the whole image, pixels, when the camera is a crop of it; 0: it is not.
  int whole_width_px = 0;
};

/// Simulates the sensor. The noise of a pixel depends on (seed, pixel) only.
SensorImage SimulateTimeOfFlight(const RenderedImage& rendered, const Camera& camera,
                                 const TimeOfFlightOptions& options, uint64_t seed);

}  // namespace ossa::depth
