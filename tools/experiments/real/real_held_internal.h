#pragma once
#include <cstdint>

#include "tools/experiments/real/real_sets_internal.h"
#include "tools/tracker/tracker.h"

namespace ossa::tools {

/// Numbers of images with so many bodies.
struct BodyCounts {
  int64_t one = 0, nobody = 0;
  int64_t bodies = 0;  // the sum over all images

  void Add(size_t in_image);
};

/// The bodies in the first frame, and in the last one, of images that a sensor at rest shows for a
/// second: what is nobody must not become somebody by chance.
struct HeldScore {
  int64_t images = 0;
  BodyCounts first, last;
};

/// The frame as a structured-light sensor at rest measures it again: normally distributed noise in
/// each reading, independent of its neighbours' (a real sensor's is not). Equal seeds give equal
/// noise.
depth::DepthFrame MeasuredAgain(depth::DepthFrame frame, uint64_t seed);

/// Shows a frame for a second, 30 Hz, the first time without noise. Resets the tracker first.
void AddHeld(const depth::DepthFrame& frame, uint64_t seed, tracker::Tracker& tracker,
             HeldScore& score);

}  // namespace ossa::tools
