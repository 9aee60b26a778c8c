#pragma once
#include <cstdint>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Decides by the curvature of slanted planes whether images hold distances or numbers that grow
/// towards the camera. Along any image line of a plane 1 / z is linear, so z deviates from its
/// chord by z'' = 2 z'^2 / z; in an image of M - z the sign is reversed. Floors, walls and tables
/// are planes in any scene.
class SurfaceBend {
 public:
  void Add(const DepthView& image);
  /// True only if there are enough surfaces and most of them have the wrong sign.
  bool IsInverted() const;
  /// True if there are a few surfaces and most have the right sign: enough to override other
  /// evidence.
  bool IsNotInverted() const;

 private:
  void AddLines(const DepthView& image, bool columns);

  int64_t windows_ = 0;    // evaluated stretches of lines,
  int64_t as_planes_ = 0;  // those with the curvature of planes,
  int64_t opposite_ = 0;   // and with the opposite one
};

}  // namespace ossa::depth
