#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

namespace ossa::tools {

/// Colours as red, green, blue bytes; row-major, height x width x 3.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgb;

  Picture() = default;
  Picture(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<size_t>(w) * static_cast<size_t>(h), 255) {}
};

/// Writes one PNG; the file appears when complete. Throws InputError if it cannot be written.
void WritePicture(const std::filesystem::path& path, const Picture& picture);

/// An animated PNG (APNG 1.0: browsers play it, other programs show its first frame). All frames
/// must be of one size; plays in an endless loop with `frame_ms` per frame.
void WriteAnimation(const std::filesystem::path& path, const std::vector<Picture>& frames,
                    int frame_ms);

/// `count` frames of the animation, evenly spaced, side by side.
Picture Strip(const std::vector<Picture>& frames, int count);

/// Pictures of equal size in a grid with `columns` columns.
Picture Sheet(const std::vector<Picture>& pictures, int columns);

}  // namespace ossa::tools
