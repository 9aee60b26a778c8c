#pragma once
#include <cstdint>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"

namespace ossa::tools {

/// Small pictures of one size in rows, on black.
class ContactSheet {
 public:
  /// `count` tiles of so many pixels, `columns` in a row.
  ContactSheet(int count, int columns, int tile_width, int tile_height);

  /// Depth as greys, the nearer the brighter, and over it each pixel whose label is not 0 in its
  /// body part's colour. Images are made smaller (or larger) by their nearest pixels. An image may
  /// be empty: it is left out; else both have one size.
  void Draw(int tile, const depth::DepthFrame& depth, const depth::Image<uint8_t>& labels);
  std::vector<uint8_t> EncodePng() const;

 private:
  int columns_, width_, height_, rows_;  // tiles in a row; of a tile, pixels; rows of tiles
  std::vector<uint8_t> samples_;         // red, green, blue
};

}  // namespace ossa::tools
