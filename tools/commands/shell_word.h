#pragma once
#include <algorithm>
#include <string>
#include <string_view>

namespace ossa::commands {

/// The text as one word of a shell: unchanged, or quoted.
inline std::string ShellWord(const std::string& text) {
  const std::string_view plain = "/._-+,:=@%";
  const auto is_plain = [plain](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           (static_cast<unsigned char>(c) & 0x80U) != 0 || plain.find(c) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace ossa::commands
