#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace ossa::tools {

/// Base64 of RFC 4648, section 4, with padding: for data embedded in pages.
inline std::string Base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t group = 0;
    for (size_t k = 0; k < 3; ++k) {
      const size_t at = i + k;
      group = group << 8U | (at < bytes.size() ? static_cast<uint8_t>(bytes[at]) : 0U);
    }
    for (unsigned k = 0; k < 4; ++k) {
      const bool is_padding = i + k > bytes.size();
      text += is_padding ? '=' : kDigits[group >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

}  // namespace ossa::tools
