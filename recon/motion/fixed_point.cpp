#include <array>
#include <charconv>
#include <limits>
#include <string_view>

#include "recon/motion/fixed_point_internal.h"

namespace ossa::recon {
namespace {

// The largest double has 309 digits before the point.
constexpr int kMostDigits = 20;  // a bound; by hand
constexpr int kLongest = std::numeric_limits<double>::max_exponent10 + kMostDigits + 3;

}  // namespace

void AppendFixed(std::string& text, double value, int digits) {
  std::array<char, kLongest> buffer;
  char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                  std::chars_format::fixed, digits)
                        .ptr;
  std::string_view shown(buffer.data(), static_cast<size_t>(end - buffer.data()));
  while (shown.ends_with('0')) shown.remove_suffix(1);
  if (shown.ends_with('.')) shown.remove_suffix(1);
  text += shown == "-0" ? "0" : shown;
}

}  // namespace ossa::recon
