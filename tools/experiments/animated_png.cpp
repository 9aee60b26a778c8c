#include "tools/experiments/animated_png.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "depth/base/atomic_file.h"
#include "depth/image/colour_png.h"

namespace ossa::tools {
namespace {

using Bytes = std::vector<uint8_t>;

/// A part of a frame; alpha 0 where the frame before it stays.
struct Patch {
  int x = 0, y = 0, width = 0, height = 0;
  std::vector<uint8_t> rgba;
};

Bytes EncodePng(const Picture& picture) {
  return depth::EncodeColourPng(picture.rgb, {picture.width, picture.height}, 3);
}

Bytes EncodePng(const Patch& patch) {
  return depth::EncodeColourPng(patch.rgba, {patch.width, patch.height}, 4);
}

/// The smallest rectangle (at least one pixel) of `frame` that differs from `before` (null: all of
/// it).
Patch FindPatch(const Picture& frame, const Picture* before) {
  const auto changed = [&](int x, int y) {
    const size_t at = 3 * static_cast<size_t>(y * frame.width + x);
    return before == nullptr || !std::equal(&frame.rgb[at], &frame.rgb[at] + 3, &before->rgb[at]);
  };
  int left = frame.width - 1, right = 0, top = frame.height - 1, bottom = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      if (!changed(x, y)) continue;
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
  }
  if (right < left) left = right = top = bottom = 0;
  Patch patch{left, top, right - left + 1, bottom - top + 1, {}};
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const size_t at = 3 * static_cast<size_t>(y * frame.width + x);
      const bool drawn = changed(x, y);
      for (size_t c = 0; c < 3; ++c) patch.rgba.push_back(drawn ? frame.rgb[at + c] : 0);
      patch.rgba.push_back(drawn ? 255 : 0);
    }
  }
  return patch;
}

void Append(Bytes& to, uint32_t value, int bytes = 4) {
  for (int i = bytes - 1; i >= 0; --i) to.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

uint32_t Get32(const Bytes& from, size_t at) {
  return static_cast<uint32_t>(from[at]) << 24 | static_cast<uint32_t>(from[at + 1]) << 16 |
         static_cast<uint32_t>(from[at + 2]) << 8 | from[at + 3];
}

/// CRC-32 of PNG, ISO 3309.
uint32_t Crc(const uint8_t* data, size_t size) {
  uint32_t crc = 0xffffffffU;
  for (size_t i = 0; i < size; ++i) {
    crc ^= data[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

void AppendChunk(Bytes& file, const char* type, const Bytes& payload) {
  Append(file, static_cast<uint32_t>(payload.size()));
  const size_t start = file.size();
  file.insert(file.end(), type, type + 4);
  file.insert(file.end(), payload.begin(), payload.end());
  Append(file, Crc(file.data() + start, file.size() - start));
}

constexpr size_t kSignatureBytes = 8, kHeaderChunkBytes = 25;  // PNG's format

/// The compressed pixels of a PNG, its IDAT chunks joined.
Bytes PixelData(const Bytes& png) {
  Bytes data;
  for (size_t at = kSignatureBytes; at + 12 <= png.size();) {
    const size_t size = Get32(png, at);
    if (std::string(png.begin() + static_cast<std::ptrdiff_t>(at) + 4,
                    png.begin() + static_cast<std::ptrdiff_t>(at) + 8) == "IDAT") {
      const auto begin = png.begin() + static_cast<std::ptrdiff_t>(at) + 8;
      data.insert(data.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
    }
    at += 12 + size;
  }
  return data;
}

Bytes FrameControl(uint32_t sequence, const Patch& frame, int frame_ms) {
  Bytes control;
  Append(control, sequence);
  Append(control, static_cast<uint32_t>(frame.width));
  Append(control, static_cast<uint32_t>(frame.height));
  Append(control, static_cast<uint32_t>(frame.x));
  Append(control, static_cast<uint32_t>(frame.y));
  Append(control, static_cast<uint32_t>(frame_ms), 2);
  Append(control, 1000, 2);  // the delay is frame_ms / 1000 s
  control.push_back(0);      // dispose: keep the frame
  control.push_back(1);      // blend: over the previous frame
  return control;
}

void WriteBytes(const std::filesystem::path& path, const Bytes& bytes) {
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.Commit();
}

}  // namespace

void WritePicture(const std::filesystem::path& path, const Picture& picture) {
  WriteBytes(path, EncodePng(picture));
}

void WriteAnimation(const std::filesystem::path& path, const std::vector<Picture>& frames,
                    int frame_ms) {
  if (frames.empty()) throw std::invalid_argument("WriteAnimation: no frames");
  const Bytes first = EncodePng(FindPatch(frames[0], nullptr));
  Bytes file(first.begin(),
             first.begin() + static_cast<std::ptrdiff_t>(kSignatureBytes + kHeaderChunkBytes));
  Bytes animation;
  Append(animation, static_cast<uint32_t>(frames.size()));
  Append(animation, 0);  // endless loop
  AppendChunk(file, "acTL", animation);
  uint32_t sequence = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].width != frames[0].width || frames[i].height != frames[0].height) {
      throw std::invalid_argument("WriteAnimation: frames differ in size");
    }
    const Patch patch = FindPatch(frames[i], i == 0 ? nullptr : &frames[i - 1]);
    AppendChunk(file, "fcTL", FrameControl(sequence++, patch, frame_ms));
    const Bytes pixels = PixelData(i == 0 ? first : EncodePng(patch));
    if (i == 0) {
      AppendChunk(file, "IDAT", pixels);
      continue;
    }
    Bytes numbered;
    Append(numbered, sequence++);
    numbered.insert(numbered.end(), pixels.begin(), pixels.end());
    AppendChunk(file, "fdAT", numbered);
  }
  AppendChunk(file, "IEND", {});
  WriteBytes(path, file);
}

Picture Strip(const std::vector<Picture>& frames, int count) {
  count = std::min(count, static_cast<int>(frames.size()));
  std::vector<Picture> picked;
  for (int k = 0; k < count; ++k) {
    const size_t last = frames.size() - 1;
    picked.push_back(
        frames[count == 1 ? 0 : static_cast<size_t>(k) * last / static_cast<size_t>(count - 1)]);
  }
  return Sheet(picked, count);
}

Picture Sheet(const std::vector<Picture>& pictures, int columns) {
  if (pictures.empty()) return {};
  const int w = pictures[0].width, h = pictures[0].height;
  const int rows = (static_cast<int>(pictures.size()) + columns - 1) / columns;
  Picture sheet(w * columns, h * rows);
  const auto row_bytes = static_cast<size_t>(3 * w);
  for (size_t k = 0; k < pictures.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    for (int y = 0; y < h; ++y) {
      const uint8_t* from = pictures[k].rgb.data() + static_cast<size_t>(y) * row_bytes;
      const auto to = static_cast<size_t>((row * h + y) * columns + column) * row_bytes;
      std::copy(from, from + row_bytes, sheet.rgb.data() + to);
    }
  }
  return sheet;
}

}  // namespace ossa::tools
