#pragma once
#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "depth/image/depth_png.h"
#include "depth/image/image.h"
#include "depth/sensor/frame_source.h"

namespace ossa::test {

/// Writes a 16-bit PNG with the same value in all pixels.
inline void WriteFrame(const std::filesystem::path& path, uint16_t value, int width = 8,
                       int height = 6) {
  const depth::Image<uint16_t> image(width, height, value);
  depth::WriteDepthPng(path, {image.data.data(), width, height, width});
}

inline void WriteBytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline depth::ReadResult Next(depth::FrameSource& source) {
  return source.Read(std::chrono::milliseconds(10));
}

/// The notes of a source, one per line.
struct Notes {
  std::string text;
  depth::SourceOptions Options() {
    depth::SourceOptions options;
    options.note = [this](depth::NoteKind, const std::string& note) { text += note + "\n"; };
    return options;
  }
  bool Tell(const std::string& part) const { return text.find(part) != std::string::npos; }
};

/// The first pixel of each of the remaining frames.
inline std::vector<uint16_t> ValuesOf(depth::FrameSource& source) {
  std::vector<uint16_t> values;
  for (depth::ReadResult result; (result = Next(source)).status == depth::ReadStatus::kFrame;) {
    values.push_back(result.frame.depth_mm[0]);
  }
  return values;
}

}  // namespace ossa::test
