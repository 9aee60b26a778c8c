#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace ossa {

/// ASCII letters in lower case; others stay as they are, whatever the locale.
inline std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

/// A name's extension as names are compared by it: cameras and Windows write `.PNG`, `.CSV`.
inline std::string LowerCaseExtension(const std::filesystem::path& path) {
  return LowerCase(path.extension().string());
}

/// Whether a name ends in `.ossa` or `.tar.gz`, also with other letters in capitals. `ending` is in
/// lower case.
inline bool HasEnding(std::string_view name, std::string_view ending) {
  return name.size() >= ending.size() &&
         LowerCase(name.substr(name.size() - ending.size())) == ending;
}

}  // namespace ossa
