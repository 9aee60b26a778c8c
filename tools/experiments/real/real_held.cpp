// Stills as recordings in which nothing moves.
#include <algorithm>
#include <cmath>

#include "depth/base/random.h"
#include "tools/experiments/real/real_held_internal.h"

namespace ossa::tools {
namespace {

// Constants: chosen by hand; they define the figures and are never tuned.

constexpr int kFrames = 30;            // a second: longer than a new person is judged
constexpr double kFrame_s = 1.0 / 30;  // the rate of a Kinect v1

// Standard deviation of a reading at 1 m, in metres, which grows with the square of the distance:
// Khoshelham & Elberink 2012, half a pixel of the disparity of a Kinect v1.
constexpr double kNoise_per_m = 1.425e-3;

}  // namespace

void BodyCounts::Add(size_t in_image) {
  one += in_image == 1;
  nobody += in_image == 0;
  bodies += static_cast<int64_t>(in_image);
}

depth::DepthFrame MeasuredAgain(depth::DepthFrame frame, uint64_t seed) {
  constexpr double kFarthest_mm = 0xFFFF;  // the largest reading of 16 bits
  constexpr double kNoise_per_mm = 1e-3 * kNoise_per_m;
  Random random(seed);
  for (uint16_t& depth_mm : frame.depth_mm) {
    if (depth_mm == 0) continue;
    const double z_mm = depth_mm;
    const double noise_mm = kNoise_per_mm * z_mm * z_mm * NearlyNormal(random.Bits());
    depth_mm = static_cast<uint16_t>(std::lround(std::clamp(z_mm + noise_mm, 1.0, kFarthest_mm)));
  }
  return frame;
}

void AddHeld(const depth::DepthFrame& frame, uint64_t seed, tracker::Tracker& tracker,
             HeldScore& score) {
  tracker.Reset();
  ++score.images;
  size_t bodies = 0;
  for (int f = 0; f < kFrames; ++f) {
    depth::DepthFrame shown =
        f == 0 ? frame : MeasuredAgain(frame, MixSeed(seed, static_cast<uint64_t>(f)));
    shown.time_s = f * kFrame_s;
    bodies = tracker.Track(shown).bodies.size();
    if (f == 0) score.first.Add(bodies);
  }
  score.last.Add(bodies);
}

}  // namespace ossa::tools
