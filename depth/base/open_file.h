#pragma once
#include <filesystem>
#include <fstream>
#include <system_error>

namespace ossa {

/// The file for reading bytes; a stream that failed for anything but a regular file: to open a pipe
/// that nobody writes to is to wait for ever.
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
