#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "depth/image/depth_frame.h"
#include "forest/trees/node_lines_internal.h"
#include "forest/trees/tree.h"

namespace ossa::forest {

/// One object cropped from a depth image: a box of (width + 2) × (height + 2) pixels in which the
/// outermost ring, and every pixel outside the object, is background. Probes outside the box are
/// clamped to the ring.
struct ObjectImage {
  int width = 0;  // excluding the ring
  int height = 0;
  int u0 = 0;  // image coordinates of the box's first pixel
  int v0 = 0;
  float scale_u = 0.0F;  // offset units · mm to pixels: (fx / 575) · 1000 / 16
  float scale_v = 0.0F;
  std::vector<uint16_t> depth_mm;  // row-major with the ring, + 2 elements so that a 32-bit read
                                   // of the last one stays inside

  int stride() const { return width + 2; }
  size_t At(int x, int y) const {  // box coordinates
    return static_cast<size_t>(y + 1) * static_cast<size_t>(stride()) + static_cast<size_t>(x + 1);
  }
};

/// Calls function(row, first, last) for each row of ascending indices, row · row_length + column:
/// index[first] ... index[last - 1] are in that row.
template <typename Function>
void ForRows(std::span<const int32_t> place, int32_t row_length, const Function& function) {
  for (auto first = place.begin(), last = first; first != place.end(); first = last) {
    const int32_t row = *first / row_length;
    const auto most = first + std::min<ptrdiff_t>(place.end() - first, row_length);
    last = std::lower_bound(first, most, (int64_t{row} + 1) * row_length);
    function(row, static_cast<size_t>(first - place.begin()),
             static_cast<size_t>(last - place.begin()));
  }
}

inline constexpr int32_t kPositionRow = 1 << 16;  // positions are y << 16 | x; of the format

/// Depth at a position y << 16 | x.
inline int DepthAt(const ObjectImage& image, int32_t position) {
  return image.depth_mm[image.At(position & 0xffff, position >> 16)];
}

/// Factor from offset units to pixels · millimetres, for a focal length.
inline float OffsetScale(double focal_px) {
  return static_cast<float>(focal_px / kReferenceFocal_px * 1000.0 / kOffsetUnitsPerPixelMetre);
}

/// Crops the pixels (v * width + u) of one object. Pixels without a reading are background.
ObjectImage CutOut(const depth::DepthView& depth, const depth::Camera& camera,
                   std::span<const int32_t> pixels, uint16_t background_mm);

/// Nearest integer, ties to even, as CVTPS2DQ does; for |x| < 2^22. Plain arithmetic, which
/// compilers vectorise, with the same result on every code path.
inline int32_t RoundToEven(float x) {
  constexpr float kMagic = 12582912.0F;  // 1.5 · 2^23
  return std::bit_cast<int32_t>(x + kMagic) - std::bit_cast<int32_t>(kMagic);
}

/// Index into ObjectImage::depth_mm of a probe of a pixel (x, y of the box).
/// Departure from eq. 1: pixels outside the object, not only outside the image, read as background.
inline int32_t ProbeIndex(int x, int y, float offset_u, float offset_v, float pixels_u,
                          float pixels_v, int width, int height, int stride) {
  int px = x + RoundToEven(offset_u * pixels_u);
  int py = y + RoundToEven(offset_v * pixels_v);
  px = px < -1 ? -1 : (px > width ? width : px);
  py = py < -1 ? -1 : (py > height ? height : py);
  return (py + 1) * stride + px + 1;
}

/// Walks of trained trees scale offsets in fixed point: pixels per offset unit, in 1/2^15, sixteen
/// per vector operation. The difference from ProbeIndex is at most a thousandth of the offset.
inline int32_t FixedScale(float scale, float depth_mm) {
  return RoundToEven(std::min(scale * 32768.0F / depth_mm, 32767.0F));
}
inline int32_t ScaleOffset(int32_t offset, int32_t fixed_scale) {
  return (offset * fixed_scale + (1 << 14)) >> 15;
}

/// Finds the leaves reached by pixels of an object in one tree, in the order of its lines.
struct WalkInput {
  const LinedTree* tree = nullptr;
  const ObjectImage* image = nullptr;
  std::span<const int32_t> position;  // y << 16 | x, box coordinates
};

/// leaf[i * leaf_stride] = leaf of position[i].
void WalkScalar(const WalkInput& input, int32_t* leaf, size_t leaf_stride);
/// The same result with 128 pixels interleaved. Precondition: HasAvx2()
/// (depth/base/cpu_dispatch.h).
void WalkAvx2(const WalkInput& input, int32_t* leaf, size_t leaf_stride);
/// The fastest version for this machine.
void Walk(const WalkInput& input, int32_t* leaf, size_t leaf_stride);

}  // namespace ossa::forest
