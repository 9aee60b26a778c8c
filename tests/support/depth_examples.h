#pragma once
#include <cstdint>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"
#include "depth/image/depth_png.h"

namespace ossa::test {

/// A small frame whose every pixel is different from those around it and from the next frame's.
inline depth::DepthFrame ExampleFrame(int index, int width = 32, int height = 24) {
  depth::DepthFrame frame;
  frame.camera = depth::KinectV1Camera(width, height);
  frame.index = index;
  frame.time_s = index / 30.0;
  std::mt19937 random(static_cast<uint32_t>(index) + 1);
  frame.depth_mm.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
  for (uint16_t& value : frame.depth_mm) value = static_cast<uint16_t>(500 + random() % 4000);
  return frame;
}

/// Frames 0 .. count-1 as 000000.png and so on.
inline void WriteExampleFolder(const std::filesystem::path& folder, int count, int width = 32,
                               int height = 24) {
  for (int i = 0; i < count; ++i) {
    const std::string digits = std::to_string(i);
    const std::string name = std::string(6 - digits.size(), '0') + digits + ".png";
    depth::WriteDepthPng(folder / name, ExampleFrame(i, width, height).view());
  }
}

}  // namespace ossa::test
