#include "depth/base/long_name.h"

#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace ossa {

std::string ShortenName(const std::string& name, size_t bytes) {
  constexpr size_t kExtension = 16;  // longest extension, bytes; by hand: longer than any of ossa's
  const std::string extension = std::filesystem::path(name).extension().string();
  std::array<char, 18> digest{};  // by definition: '-', 16 digits and the terminator
  std::snprintf(digest.data(), digest.size(), "-%016llx",
                static_cast<unsigned long long>(XXH3_64bits(name.data(), name.size())));
  std::string end = digest.data();
  if (extension.size() <= kExtension) end += extension;
  size_t cut = bytes > end.size() ? bytes - end.size() : 0;
  const auto continues = [&](size_t at) {
    return (static_cast<unsigned>(name[at]) & 0xC0U) == 0x80U;
  };
  while (cut > 0 && continues(cut)) --cut;
  return name.substr(0, cut) + end;
}

size_t LongestNameIn(const std::filesystem::path& folder) {
  return static_cast<size_t>(std::max(0L, pathconf(folder.c_str(), _PC_NAME_MAX)));
}

}  // namespace ossa
