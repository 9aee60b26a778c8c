#include <algorithm>
#include <cstring>

#include "depth/base/error.h"
#include "depth/image/camera.h"
#include "depth/image/image_bytes_internal.h"
#include "depth/image/number_image_internal.h"

namespace ossa::depth {
namespace {

// Columns one after the other to rows.
std::vector<uint8_t> Transposed(std::span<const uint8_t> columns, ImageSize size, size_t bytes) {
  std::vector<uint8_t> rows(columns.size());
  const auto width = static_cast<size_t>(size.width), height = static_cast<size_t>(size.height);
  for (size_t x = 0; x < width; ++x) {
    for (size_t y = 0; y < height; ++y) {
      std::memcpy(&rows[(y * width + x) * bytes], &columns[(x * height + y) * bytes], bytes);
    }
  }
  return rows;
}

}  // namespace

NumberImage ReadNpy(const std::filesystem::path& path, ReadPart part) {
  const std::vector<uint8_t> bytes =
      part == ReadPart::kHeader ? ReadImageBytes(path, kLongestNpyHeader) : ReadImageBytes(path);
  const NpyHeader header = ParseNpyHeader(bytes, path.string() + ": ");
  std::vector<size_t> sides = header.shape;
  std::erase(sides, 1);
  const auto is_side = [](size_t side) { return side > 0 && side <= kLargestImageSide; };
  if (sides.size() != 2 || !std::all_of(sides.begin(), sides.end(), is_side)) {
    throw InputError(path.string() + ": expected an image, height x width, found an array of " +
                     ShapeText(header.shape));
  }
  NumberImage image;
  image.size = {static_cast<int>(sides[1]), static_cast<int>(sides[0])};
  image.format = header.format;
  if (part == ReadPart::kHeader) return image;
  const auto each = static_cast<size_t>(header.format.size);
  const size_t expected = sides[0] * sides[1] * each;
  if (bytes.size() - header.data_offset < expected) {
    throw InputError(path.string() + ": cut short: expected " + std::to_string(expected) +
                     " bytes after the header, found " +
                     std::to_string(bytes.size() - header.data_offset));
  }
  const auto numbers = std::span(bytes).subspan(header.data_offset, expected);
  image.numbers = header.is_fortran ? Transposed(numbers, image.size, each)
                                    : std::vector<uint8_t>(numbers.begin(), numbers.end());
  return image;
}

}  // namespace ossa::depth
