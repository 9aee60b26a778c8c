#pragma once
#include <filesystem>
#include <fstream>
#include <system_error>

namespace ossa {

/// Opens a file for reading bytes; returns a failed stream for anything but a regular file, because
/// opening a pipe without a writer blocks forever.
inline std::ifstream OpenFile(const std::filesystem::path& path, std::ios::openmode more = {}) {
  std::error_code unknown;
  std::ifstream file;
  if (std::filesystem::is_regular_file(path, unknown)) {
    file.open(path, std::ios::binary | more);
  } else {
    file.setstate(std::ios::failbit);
  }
  return file;
}

}  // namespace ossa
