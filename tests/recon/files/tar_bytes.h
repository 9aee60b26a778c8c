#pragma once
// A .tar made here, of nothing but its documented layout.
#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace ossa::recon {

/// The header of a member: name, mode, owner, group, size, time, check sum, kind, magic.
inline std::string TarHeader(const std::string& name, size_t size) {
  std::string header(512, '\0');
  const auto put = [&](size_t at, const std::string& text) {
    header.replace(at, text.size(), text);
  };
  put(0, name);
  put(100, "0000644");
  put(108, "0000000");
  put(116, "0000000");
  put(124, fmt::format("{:011o}", size));
  put(136, "00000000000");
  put(148, "        ");
  put(156, "0");
  put(257, std::string("ustar\00000", 8));
  unsigned sum = 0;
  for (const char c : header) sum += static_cast<uint8_t>(c);
  put(148, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
  return header;
}

/// Members are given by name and content.
inline void WriteTar(const std::filesystem::path& path,
                     const std::vector<std::pair<std::string, std::string>>& members) {
  std::ofstream file(path, std::ios::binary);
  for (const auto& [name, content] : members) {
    file << TarHeader(name, content.size()) << content
         << std::string((512 - content.size() % 512) % 512, '\0');
  }
  file << std::string(1024, '\0');
}

}  // namespace ossa::recon
