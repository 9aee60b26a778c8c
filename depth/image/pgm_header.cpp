#include "depth/image/pgm_header.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "depth/base/error.h"
#include "depth/image/camera.h"

namespace ossa::depth {
namespace {

constexpr std::string_view kMagic = "P5";
constexpr std::string_view kBlanks = " \t\n\v\f\r";

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Reads the numbers of a header, between which there are blanks and comments.
class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  // None if the text ends before a blank follows the number.
  std::optional<int> Next(const char* what, int most) {
    SkipBlanks();
    if (at_ == text_.size()) return std::nullopt;
    int number = 0;
    const auto parsed = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
    if (parsed.ec != std::errc() || number < 1 || number > most) {
      throw InputError(name_ + ": expected the " + what + " of a PGM image, 1 to " +
                       std::to_string(most));
    }
    at_ = static_cast<size_t>(parsed.ptr - text_.data());
    if (at_ == text_.size()) return std::nullopt;
    if (kBlanks.find(text_[at_]) == std::string_view::npos) {
      throw InputError(name_ + ": expected a blank behind the " + what + " of a PGM image");
    }
    return number;
  }
  // Where the pixels begin, behind a single blank.
  size_t end() const { return at_ + 1; }
  std::vector<std::string> TakeComments() { return std::move(comments_); }

 private:
  void SkipBlanks() {
    for (;;) {
      at_ = std::min(text_.find_first_not_of(kBlanks, at_), text_.size());
      if (at_ == text_.size() || text_[at_] != '#') return;
      const size_t line_end = std::min(text_.find_first_of("\r\n", at_), text_.size());
      comments_.emplace_back(Trimmed(text_.substr(at_ + 1, line_end - at_ - 1)));
      at_ = line_end;
    }
  }

  std::string_view text_;
  std::string name_;
  size_t at_ = kMagic.size();
  std::vector<std::string> comments_;
};

}  // namespace

size_t PgmHeader::ImageBytes() const {
  return static_cast<size_t>(size.width) * static_cast<size_t>(size.height) *
         static_cast<size_t>(bytes);
}

std::optional<PgmHeader> ParsePgmHeader(std::string_view text, const std::string& name) {
  constexpr int kBrightest = 65535;  // by definition
  if (text.substr(0, kMagic.size()) != kMagic.substr(0, text.size())) {
    throw InputError(name + ": expected a binary PGM image, P5, found '" +
                     std::string(text.substr(0, kMagic.size())) + "'");
  }
  if (text.size() < kMagic.size()) return std::nullopt;
  HeaderReader reader(text, name);
  const auto width = reader.Next("width", kLargestImageSide);
  const auto height = width ? reader.Next("height", kLargestImageSide) : std::nullopt;
  const auto brightest = height ? reader.Next("brightest value", kBrightest) : std::nullopt;
  if (!brightest) return std::nullopt;
  return PgmHeader{.size = {*width, *height},
                   .bytes = *brightest < 256 ? 1 : 2,
                   .comments = reader.TakeComments(),
                   .image_at = reader.end()};
}

}  // namespace ossa::depth
