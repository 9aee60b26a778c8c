#include <algorithm>
#include <bit>

#include "depth/base/cpu_dispatch.h"
#include "forest/trees/depth_feature_internal.h"

namespace ossa::forest {

ObjectImage CutOut(const depth::DepthView& depth, const depth::Camera& camera,
                   std::span<const int32_t> pixels, uint16_t background_mm) {
  ObjectImage image;
  image.scale_u = OffsetScale(camera.fx);
  image.scale_v = OffsetScale(camera.fy);
  int u1 = -1;
  image.u0 = depth.width;
  image.v0 = pixels.empty() ? 0 : pixels.front() / depth.width;
  const int v1 = pixels.empty() ? -1 : pixels.back() / depth.width;
  ForRows(pixels, depth.width, [&](int v, size_t first, size_t last) {
    image.u0 = std::min(image.u0, pixels[first] - v * depth.width);
    u1 = std::max(u1, pixels[last - 1] - v * depth.width);
  });
  image.width = std::max(0, u1 - image.u0 + 1);
  image.height = v1 - image.v0 + 1;
  image.depth_mm.assign(
      static_cast<size_t>(image.stride()) * static_cast<size_t>(image.height + 2) + 2,
      background_mm);
  ForRows(pixels, depth.width, [&](int v, size_t first, size_t last) {
    uint16_t* row = &image.depth_mm[image.At(0, v - image.v0)];
    for (size_t i = first; i < last; ++i) {
      const int u = pixels[i] - v * depth.width;
      const uint16_t mm = depth.at(u, v);
      if (mm != 0) row[u - image.u0] = std::min(mm, background_mm);
    }
  });
  return image;
}

namespace {

// An exit of a line: whether it leads to another line, and the index of that line or leaf.
struct WayOut {
  bool goes_on = false;
  int32_t number = 0;
};

WayOut LeaveLine(const NodeLine& line, uint32_t way) {
  const uint32_t bit = 1U << way;
  const bool goes_on = (line.lines & bit) != 0;
  const uint32_t ways = goes_on ? line.lines : line.leaves;
  return {goes_on, static_cast<int32_t>(ways >> 8U) + std::popcount(ways & (bit - 1))};
}

int32_t WalkOne(const WalkInput& input, int x, int y) {
  const ObjectImage& image = *input.image;
  const LinedTree& tree = *input.tree;
  const uint16_t* depth_mm = image.depth_mm.data();
  const auto d_mm = static_cast<float>(depth_mm[image.At(x, y)]);
  const int scale_u = FixedScale(image.scale_u, d_mm);
  const int scale_v = FixedScale(image.scale_v, d_mm);
  const auto read = [&](int steps_u, int steps_v) {
    const int offset_u = ScaleOffset(steps_u * tree.offset_step, scale_u);
    const int offset_v = ScaleOffset(steps_v * tree.offset_step, scale_v);
    const int probe_x = std::clamp(x + offset_u, -1, image.width);
    const int probe_y = std::clamp(y + offset_v, -1, image.height);
    return static_cast<int>(depth_mm[image.At(probe_x, probe_y)]);
  };
  auto at = static_cast<size_t>(tree.first_node);
  for (WayOut out{true, 0};; at = 0) {
    const NodeLine& line = tree.lines[static_cast<size_t>(out.number)];
    while (at < line.node.size()) {
      const PackedNode& node = line.node[at];
      const int response_mm =
          read(node.offset(0), node.offset(1)) - read(node.offset(2), node.offset(3));
      at = 2 * at + (response_mm > node.threshold_mm() ? 2 : 1);
    }
    out = LeaveLine(line, static_cast<uint32_t>(at - line.node.size()));
    if (!out.goes_on) return out.number;
  }
}

}  // namespace

void WalkScalar(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  for (size_t i = 0; i < input.position.size(); ++i) {
    leaf[i * leaf_stride] = WalkOne(input, input.position[i] & 0xffff, input.position[i] >> 16);
  }
}

void Walk(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  static const bool has_avx2 = HasAvx2();
  (has_avx2 ? WalkAvx2 : WalkScalar)(input, leaf, leaf_stride);
}

}  // namespace ossa::forest
