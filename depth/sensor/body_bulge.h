#pragma once
#include <cstdint>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Decides by the convexity of isolated objects whether images hold distances or numbers that grow
/// towards the camera. A limb, trunk or head is nearest in its middle and recedes towards its
/// outline, so z'' > 0 along a line across it. In an image of M - z it looks like a hole,
/// surrounded by smaller numbers or none, that is farthest in its middle. Unlike SurfaceBend this
/// needs no floor or wall: people cut out suffice.
class BodyBulge {
 public:
  /// For images with this many units per millimetre.
  explicit BodyBulge(double units_per_mm = 1.0) : units_per_mm_(units_per_mm) {}
  void Add(const DepthView& image);
  /// Whether there is enough evidence to decide.
  bool IsEnough() const;
  /// True only with enough evidence, most of it hollow (or round).
  bool IsHollow() const;
  bool IsRound() const;

 private:
  double units_per_mm_;
  int64_t images_ = 0;
  int64_t round_ = 0;   // convex stretches of objects in front
  int64_t hollow_ = 0;  // concave stretches of apparent holes
};

}  // namespace ossa::depth
