#include "forest/feature_internal.h"

#include <algorithm>

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

void WalkScalar(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  const ObjectImage& image = *input.image;
  const uint16_t* depth_mm = image.depth_mm.data();
  for (size_t i = 0; i < input.position.size(); ++i) {
    const int x = input.position[i] & 0xffff;
    const int y = input.position[i] >> 16;
    const auto d_mm = static_cast<float>(depth_mm[image.At(x, y)]);
    const int scale_u = FixedScale(image.scale_u, d_mm);
    const int scale_v = FixedScale(image.scale_v, d_mm);
    const auto read = [&](const std::array<int16_t, 2>& offset) {
      const int probe_x = std::clamp(x + ScaleOffset(offset[0], scale_u), -1, image.width);
      const int probe_y = std::clamp(y + ScaleOffset(offset[1], scale_v), -1, image.height);
      return static_cast<int>(depth_mm[image.At(probe_x, probe_y)]);
    };
    const Node* node = input.nodes;
    while (!node->is_leaf()) {
      const int response_mm = read(node->u) - read(node->v);
      node = input.nodes + node->left + (response_mm > node->threshold_mm ? 1 : 0);
    }
    leaf[i * leaf_stride] = node->leaf();
  }
}

void Walk(const WalkInput& input, int32_t* leaf, size_t leaf_stride) {
  static const bool has_avx2 = HasAvx2();
  (has_avx2 ? WalkAvx2 : WalkScalar)(input, leaf, leaf_stride);
}

}  // namespace ossa::forest
