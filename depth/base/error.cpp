#include "depth/base/error.h"

#include "depth/base/one_line.h"

namespace ossa {
namespace {

// Length of the UTF-8 character at the start of `text`; 0 for invalid UTF-8 or a control character.
size_t PrintableLength(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first < 0x20 || first == 0x7F ? 0 : 1;
  const size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || length > text.size()) return 0;
  for (size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return 0;
  }
  // The second byte shows overlong encodings, surrogates and out-of-range characters; U+0080 to
  // U+009F are control characters, too.
  const unsigned char second = byte(1);
  const bool bad = (first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
                   (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F) ||
                   (first == 0xC2 && second < 0xA0);
  return bad ? 0 : length;
}

}  // namespace

std::string OnOneLine(std::string_view text) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string line;
  while (!text.empty()) {
    size_t length = PrintableLength(text);
    if (length > 0) {
      line += text.substr(0, length);
    } else {
      const auto code = static_cast<unsigned char>(text[0]);
      line += {'\\', 'x', kDigits[code / 16], kDigits[code % 16]};
      length = 1;
    }
    text.remove_prefix(length);
  }
  return line;
}

InputError::InputError(const std::string& message) : std::runtime_error(OnOneLine(message)) {}

}  // namespace ossa
