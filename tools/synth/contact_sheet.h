#pragma once
#include <cstdint>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/image.h"

namespace ossa::tools {

/// A grid of small images of equal size on a black background.
class ContactSheet {
 public:
  /// `count` tiles of tile_width x tile_height pixels, `columns` tiles in a row.
  ContactSheet(int count, int columns, int tile_width, int tile_height);

  /// Draws depth in greys (nearer is brighter), and over it each labelled pixel in the colour of
  /// its body part. Images are resized to the tile by nearest neighbour. Depth and labels have
  /// equal size; either may be empty and is then not drawn.
  void Draw(int tile, const depth::DepthFrame& depth, const depth::Image<uint8_t>& labels);
  std::vector<uint8_t> EncodePng() const;

 private:
  int columns_, width_, height_, rows_;  // width_ and height_: of a tile, pixels
  std::vector<uint8_t> samples_;         // red, green, blue
};

}  // namespace ossa::tools
