#pragma once
// Matroska recordings as k4arecorder writes them, without calibration: one video track titled DEPTH
// of uncompressed greys of 16 bits, big end first (RFC 9559; the track's format is a
// BITMAPINFOHEADER).
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::test {

inline std::string BigEnd(uint64_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += static_cast<char>(value >> 8 * i & 0xFF);
  return text;
}

inline std::string LittleEnd(uint64_t value, int bytes) {
  const std::string text = BigEnd(value, bytes);
  return {text.rbegin(), text.rend()};
}

/// An element: its identity, the size of its contents in eight bytes, and these.
inline std::string Element(const std::string& identity, const std::string& contents) {
  return identity + BigEnd(uint64_t{1} << 56 | contents.size(), 8) + contents;
}

inline std::string DepthTrackElement(int width, int height) {
  const auto w = static_cast<uint64_t>(width), h = static_cast<uint64_t>(height);
  const std::string format = LittleEnd(40, 4) + LittleEnd(w, 4) + LittleEnd(h, 4) +
                             LittleEnd(1, 2) + LittleEnd(16, 2) + "b16g" + LittleEnd(2 * w * h, 4) +
                             std::string(16, '\0');
  return Element(
      "\xAE", Element("\xD7", "\x01") + Element("\x73\xC5", "\x01") + Element("\x83", "\x01") +
                  Element("\x53\x6E", "DEPTH") + Element("\x86", "V_MS/VFW/FOURCC") +
                  Element("\x63\xA2", format) +
                  Element("\xE0", Element("\xB0", BigEnd(w, 2)) + Element("\xBA", BigEnd(h, 2))));
}

/// A cluster of one key frame.
inline std::string FrameElement(const depth::DepthFrame& frame) {
  constexpr double kTicks = 1000.0;  // a second
  std::string block = "\x81" + std::string(2, '\0') + "\x80";
  for (const uint16_t depth : frame.depth_mm) block += BigEnd(depth, 2);
  const auto time = static_cast<uint64_t>(std::lround(frame.time_s * kTicks));
  return Element("\x1F\x43\xB6\x75", Element("\xE7", BigEnd(time, 4)) + Element("\xA3", block));
}

inline std::string MkvBytes(const std::vector<depth::DepthFrame>& frames) {
  const depth::Camera& camera = frames.at(0).camera;
  std::string segment = Element("\x15\x49\xA9\x66", Element("\x2A\xD7\xB1", BigEnd(1'000'000, 4))) +
                        Element("\x16\x54\xAE\x6B", DepthTrackElement(camera.width, camera.height));
  for (const depth::DepthFrame& frame : frames) segment += FrameElement(frame);
  return Element("\x1A\x45\xDF\xA3", Element("\x42\x82", "matroska")) +
         Element("\x18\x53\x80\x67", segment);
}

inline void WriteMkv(const std::filesystem::path& path,
                     const std::vector<depth::DepthFrame>& frames) {
  std::ofstream(path, std::ios::binary) << MkvBytes(frames);
}

}  // namespace ossa::test
