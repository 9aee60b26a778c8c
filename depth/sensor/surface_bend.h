#pragma once
#include <cstdint>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Whether images are of distances, or of numbers that grow towards the camera: by how slanted
/// surfaces bend in them. Along any line of an image of a plane 1 / z is linear, and so z itself
/// bends away from its chord by z'' = 2 z'^2 / z; if the image shows M - z it bends by as much the
/// other way. Floors, walls and tables are planes whoever stands before them.
class SurfaceBend {
 public:
  void Add(const DepthView& image);
  /// True only where surfaces enough were seen and most of them bend the wrong way.
  bool IsWrongWayRound() const;
  /// True where a few were seen and most of them bend the right way: enough to doubt who says
  /// otherwise.
  bool IsRightWayRound() const;

 private:
  void AddLines(const DepthView& image, bool columns);

  int64_t windows_ = 0;    // stretches of lines looked at,
  int64_t as_planes_ = 0;  // of which bend as planes do,
  int64_t opposite_ = 0;   // and the other way
};

}  // namespace ossa::depth
