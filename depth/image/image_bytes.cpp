#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "depth/base/error.h"
#include "depth/image/image_bytes_internal.h"

namespace ossa::depth {
namespace {

// An incompressible 16-bit image of 8192², and a margin: larger files are refused.
constexpr uintmax_t kLargestFile = uintmax_t{150} << 20;

}  // namespace

std::vector<uint8_t> ReadImageBytes(const std::filesystem::path& path, size_t at_most) {
  std::error_code error;
  const uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw InputError(path.string() + ": cannot be read: " + error.message());
  if (size > kLargestFile) {
    throw InputError(path.string() + ": expected an image file, found " + std::to_string(size) +
                     " bytes");
  }
  std::vector<uint8_t> bytes(std::min(static_cast<size_t>(size), at_most));
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file) throw InputError(path.string() + ": cannot be read: expected an image");
  return bytes;
}

std::vector<uint8_t> ReadImageBytes(const std::filesystem::path& path) {
  return ReadImageBytes(path, kLargestFile);
}

}  // namespace ossa::depth
