#include <algorithm>
#include <bit>
#include <charconv>
#include <string_view>

#include "depth/base/error.h"
#include "depth/image/camera.h"
#include "depth/image/image_bytes_internal.h"
#include "depth/image/number_image_internal.h"

namespace ossa::depth {
namespace {

// Reads the numbers of a header, between which there are blanks and comments.
class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  int Next(const char* what, int most) {
    SkipBlanks();
    int number = 0;
    const auto parsed = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
    if (parsed.ec != std::errc() || number < 1 || number > most) {
      throw InputError(name_ + ": expected the " + what + " of a PGM image, 1 to " +
                       std::to_string(most));
    }
    at_ = static_cast<size_t>(parsed.ptr - text_.data());
    return number;
  }
  // Where the numbers of the image begin, behind a single blank.
  size_t end() const { return at_ + 1; }

 private:
  static bool IsBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  void SkipBlanks() {
    while (at_ < text_.size() && (IsBlank(text_[at_]) || text_[at_] == '#')) {
      at_ = text_[at_] == '#' ? std::min(text_.find('\n', at_), text_.size()) : at_ + 1;
    }
  }

  std::string_view text_;
  std::string name_;
  size_t at_ = 2;  // behind "P5"
};

// fakenect's dumps hold what the Kinect's driver had in memory.
bool IsFromFakenect(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with("d-") &&
         name.substr(0, name.size() - 4).find_first_not_of("d-.0123456789") == std::string::npos;
}

}  // namespace

NumberImage ReadPgm(const std::filesystem::path& path, ReadPart part) {
  constexpr size_t kLongestHeader = 4096;  // bytes, by hand: comments
  const std::vector<uint8_t> bytes =
      part == ReadPart::kHeader ? ReadImageBytes(path, kLongestHeader) : ReadImageBytes(path);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!text.starts_with("P5")) {
    throw InputError(path.string() + ": expected a binary PGM image, P5, found '" +
                     std::string(text.substr(0, 2)) + "'");
  }
  HeaderReader header(text, path.string());
  NumberImage image;
  image.size.width = header.Next("width", kLargestImageSide);
  image.size.height = header.Next("height", kLargestImageSide);
  const int brightest = header.Next("brightest value", 65535);
  const bool is_high_first = !IsFromFakenect(path);
  image.format.size = brightest < 256 ? 1 : 2;
  image.format.is_swapped = is_high_first == (std::endian::native == std::endian::little);
  if (part == ReadPart::kHeader) return image;
  const size_t expected = static_cast<size_t>(image.size.width) *
                          static_cast<size_t>(image.size.height) *
                          static_cast<size_t>(image.format.size);
  const size_t found = bytes.size() - std::min(bytes.size(), header.end());
  if (found < expected) {
    throw InputError(path.string() + ": cut short: expected " + std::to_string(expected) +
                     " bytes after the header, found " + std::to_string(found));
  }
  const auto begin = bytes.begin() + static_cast<ptrdiff_t>(header.end());
  image.numbers.assign(begin, begin + static_cast<ptrdiff_t>(expected));
  return image;
}

}  // namespace ossa::depth
