#pragma once
#include <cstdint>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Whether images are of distances, or of numbers that grow towards the camera: by how what stands
/// alone is rounded. A limb, a trunk or a head is nearest in its middle and turns away towards its
/// outline, so that z along a line across it bends as z'' > 0; if the image shows M - z it seems a
/// hole, with smaller numbers around it or none, that is farthest in its middle. Needs no floor and
/// no wall (SurfaceBend does): people cut out are enough.
class BodyBulge {
 public:
  /// Of images in so many units to the millimetre.
  explicit BodyBulge(double units_per_mm = 1.0) : units_per_mm_(units_per_mm) {}
  void Add(const DepthView& image);
  /// Whether enough was seen to decide by, either way.
  bool IsEnough() const;
  /// True only where enough was seen and most of it is hollow, or round.
  bool IsHollow() const;
  bool IsRound() const;

 private:
  double units_per_mm_;
  int64_t images_ = 0;
  int64_t round_ = 0;   // stretches across what stands out, nearest in their middle
  int64_t hollow_ = 0;  // stretches across what seems a hole, farthest in their middle
};

}  // namespace ossa::depth
