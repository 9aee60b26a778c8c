#include <algorithm>
#include <bit>
#include <string_view>

#include "depth/base/error.h"
#include "depth/image/image_bytes_internal.h"
#include "depth/image/number_image_internal.h"
#include "depth/image/pgm_header.h"

namespace ossa::depth {
namespace {

// fakenect's dumps hold what the Kinect's driver had in memory.
bool IsFromFakenect(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with("d-") &&
         name.substr(0, name.size() - 4).find_first_not_of("d-.0123456789") == std::string::npos;
}

}  // namespace

NumberImage ReadPgm(const std::filesystem::path& path, ReadPart part) {
  const std::vector<uint8_t> bytes =
      part == ReadPart::kHeader ? ReadImageBytes(path, kLongestPgmHeader) : ReadImageBytes(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const auto header = ParsePgmHeader(text.substr(0, kLongestPgmHeader), path.string());
  if (!header)
    throw InputError(path.string() +
                     ": expected a binary PGM image, found a header that is cut short");
  NumberImage image;
  image.size = header->size;
  const bool is_high_first = !IsFromFakenect(path);
  image.format.size = header->bytes;
  image.format.is_swapped = is_high_first == (std::endian::native == std::endian::little);
  if (part == ReadPart::kHeader) return image;
  const size_t expected = header->ImageBytes(), found = bytes.size() - header->image_at;
  if (found < expected) {
    throw InputError(path.string() + ": cut short: expected " + std::to_string(expected) +
                     " bytes after the header, found " + std::to_string(found));
  }
  const auto begin = bytes.begin() + static_cast<ptrdiff_t>(header->image_at);
  image.numbers.assign(begin, begin + static_cast<ptrdiff_t>(expected));
  return image;
}

}  // namespace ossa::depth
