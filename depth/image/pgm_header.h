#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "depth/image/depth_png.h"

namespace ossa::depth {

/// The header of one of Netpbm's binary grey images (P5).
struct PgmHeader {
  ImageSize size;
  int bytes = 2;                      // of a pixel: 1, or 2 with the high one first
  std::vector<std::string> comments;  // each without its # and the blanks around it
  size_t image_at = 0;                // where the pixels begin

  /// Bytes of the pixels.
  size_t ImageBytes() const;
};

/// The most bytes of a header, by hand: three numbers and comments.
inline constexpr size_t kLongestPgmHeader = 4096;

/// Parses the first bytes of an image; none if the header does not end in them. Throws InputError,
/// `name` first, for anything else.
std::optional<PgmHeader> ParsePgmHeader(std::string_view text, const std::string& name);

}  // namespace ossa::depth
