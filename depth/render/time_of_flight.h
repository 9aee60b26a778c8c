#pragma once
#include <cstdint>

#include "depth/image/camera.h"
#include "depth/render/renderer.h"
#include "depth/render/sensor_image.h"

namespace ossa::depth {

// Constants: of a Kinect v2 by the literature named, where nothing else is said; else by hand.

/// How a time-of-flight sensor (Kinect v2, Azure Kinect, Femto) falls short of a perfect one. It
/// measures the phase of light that comes back: the less light, the more noise, until nothing is
/// read; and light of two ways in one pixel gives a distance that is neither's.
struct TimeOfFlightOptions {
  /// Standard deviation of the depth of a bright, facing surface: the root of the sum of squares of
  /// the first number and of the second times z². 1.2 mm, 1.6 mm, 2.5 mm, 4.2 mm at 1, 2, 3, 4 m,
  /// within 0.3 mm of 1.5 - 0.5 z + 0.3 z² mm, Fankhauser et al. 2015, of a Kinect v2.
  double noise_m = 0.0012;
  double noise_per_m2 = 0.00025;  // 1/m, of z²
  /// Share of the light that a surface sends back where RenderedImage::reflectance says nothing.
  double usual_reflectance = 0.6;  // share
  /// A pixel also gets light from this share of its neighbours' area on every side: depths between
  /// two surfaces at their edge, the flying pixels. Weighted by how bright the surfaces are.
  double spread = 0.35;  // share
  /// Of the pixels that got light of two surfaces the sensor finds this share out and reads
  /// nothing.
  double found_out = 0.6;  // share
  /// Neighbours that differ by more than this share of their depth lie on two surfaces.
  double edge_share = 0.03;  // share
  /// Light that comes by way of a neighbouring surface: inner corners are read as if filled with up
  /// to this share of what they lie behind the surface around them, within this reach; the less the
  /// farther that surface is away.
  double corner_filling = 0.6;  // share
  double corner_reach_m = 0.06;
  /// The light falls off from the optical axis with this power of the cosine. Kinect v2: by hand,
  /// so that corners of the image have a third of the middle's light.
  double fall_off = 4.0;  // exponent
  /// Brightness below which nothing is read: reflectance times |cos| of incidence times fall-off
  /// over z² / m², in 1. By hand: dark cloth, 0.05, begins to fail at 3 m, and the floor is read as
  /// far as 4.5 m.
  double least_light = 0.004;  // share
  /// Standard deviation of that limit in patches of about this many pixels of a 640-pixel-wide
  /// image: dark surfaces are eaten away in holes, not pixel by pixel.
  double patchiness = 0.25;  // share
  double patch_px = 7.0;
  /// Where the light reaches at all: half angles from the optical axis, degrees. Beyond this
  /// ellipse nothing is read. 90 and more: everywhere.
  double reach_x_deg = 90.0;
  double reach_y_deg = 90.0;
  double nearest_m = 0.4;   // nothing is read nearer than this, nor
  double farthest_m = 6.0;  // farther than this
  /// Width of the whole image, pixels, when the camera is a crop of it; 0: it is not.
  int whole_width_px = 0;
};

/// The rendered image as the sensor delivers it. Every pixel's noise depends on (seed, pixel) only.
SensorImage SimulateTimeOfFlight(const RenderedImage& rendered, const Camera& camera,
                                 const TimeOfFlightOptions& options, uint64_t seed);

}  // namespace ossa::depth
