#include "depth/error.h"

namespace ossa {
namespace {

std::string OnOneLine(const std::string& message) {
  constexpr char kDigits[] = "0123456789ABCDEF";
  std::string line;
  for (const char c : message) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7F) {
      line += {'\\', 'x', kDigits[code / 16], kDigits[code % 16]};
    } else {
      line += c;
    }
  }
  return line;
}

}  // namespace

InputError::InputError(const std::string& message) : std::runtime_error(OnOneLine(message)) {}

}  // namespace ossa
