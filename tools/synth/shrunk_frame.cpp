#include "tools/synth/shrunk_frame.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ossa::tools {
namespace {

/// Pixels of the large crop that are kept along one axis, and the position of the first one in the
/// shrunk image.
struct KeptAxis {
  int first = 0;
  std::vector<int> from;
};

KeptAxis SampleAxis(int begin, int length, double shrink, int shrunk_length) {
  KeptAxis kept;
  for (int u = 0; u < shrunk_length; ++u) {
    const int from = static_cast<int>(std::floor((u + 0.5) * shrink)) - begin;
    if (from < 0 || from >= length) continue;
    if (kept.from.empty()) kept.first = u;
    kept.from.push_back(from);
  }
  if (kept.from.empty()) kept.from.push_back(0);  // a crop narrower than the step
  return kept;
}

}  // namespace

LabelledFrame ShrunkFrame(const LabelledFrame& frame, int u0, int v0, double shrink,
                          const depth::Camera& whole) {
  const depth::Camera& large = frame.depth.camera;
  const KeptAxis u = SampleAxis(u0, large.width, shrink, whole.width);
  const KeptAxis v = SampleAxis(v0, large.height, shrink, whole.height);
  LabelledFrame shrunk = frame;
  depth::Camera& camera = shrunk.depth.camera;
  camera = whole;
  camera.width = static_cast<int>(u.from.size());
  camera.height = static_cast<int>(v.from.size());
  camera.cx -= u.first;
  camera.cy -= v.first;
  shrunk.parts = depth::Image<uint8_t>(camera.width, camera.height);
  shrunk.users = shrunk.parts;
  shrunk.depth.depth_mm.clear();
  size_t to = 0;
  for (const int from_v : v.from) {
    for (const int from_u : u.from) {
      const auto from = static_cast<size_t>(from_v) * static_cast<size_t>(large.width) +
                        static_cast<size_t>(from_u);
      shrunk.depth.depth_mm.push_back(frame.depth.depth_mm[from]);
      shrunk.parts.data[to] = frame.parts.data[from];
      shrunk.users.data[to] = frame.users.data[from];
      ++to;
    }
  }
  return shrunk;
}

}  // namespace ossa::tools
