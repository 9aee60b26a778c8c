#include "tools/synth/contact_sheet.h"

#include <algorithm>

#include "depth/image/colour_png.h"
#include "recon/body/parts.h"

namespace ossa::tools {
namespace {

recon::Rgb Grey(uint16_t depth_mm) {
  constexpr int kNearest_mm = 500, kFarthest_mm = 5000;  // by eye: the usual range of people
  if (depth_mm == 0) return {};
  const int mm = std::clamp<int>(depth_mm, kNearest_mm, kFarthest_mm);
  const auto grey =
      static_cast<uint8_t>(235 - 190 * (mm - kNearest_mm) / (kFarthest_mm - kNearest_mm));
  return {grey, grey, grey};
}

}  // namespace

ContactSheet::ContactSheet(int count, int columns, int tile_width, int tile_height)
    : columns_(columns),
      width_(tile_width),
      height_(tile_height),
      rows_((count + columns - 1) / columns),
      samples_(size_t{3} * static_cast<size_t>(columns_ * width_) *
               static_cast<size_t>(rows_ * height_)) {}

void ContactSheet::Draw(int tile, const depth::DepthFrame& depth,
                        const depth::Image<uint8_t>& labels) {
  const int left = tile % columns_ * width_, top = tile / columns_ * height_;
  const int from_width = depth.depth_mm.empty() ? labels.width : depth.camera.width;
  const int from_height = depth.depth_mm.empty() ? labels.height : depth.camera.height;
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) {
      const auto from =
          static_cast<size_t>(v * from_height / height_ * from_width + u * from_width / width_);
      recon::Rgb colour = depth.depth_mm.empty() ? recon::Rgb{} : Grey(depth.depth_mm[from]);
      if (!labels.data.empty() && labels.data[from] != 0) {
        colour = recon::PartColour(labels.data[from]);
      }
      uint8_t* sample =
          &samples_[3 * static_cast<size_t>((top + v) * columns_ * width_ + left + u)];
      sample[0] = colour.r;
      sample[1] = colour.g;
      sample[2] = colour.b;
    }
  }
}

std::vector<uint8_t> ContactSheet::EncodePng() const {
  return depth::EncodeColourPng(samples_, {columns_ * width_, rows_ * height_}, 3);
}

}  // namespace ossa::tools
