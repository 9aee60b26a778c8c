#include <fmt/format.h>

#include <array>

#include "depth/base/error.h"
#include "recon/files/binary_bytes_internal.h"

namespace ossa::recon {

void FailAtByte(const std::string& name, size_t byte, const std::string& expected) {
  throw InputError(fmt::format("{}: byte {}: expected {}", name, byte, expected));
}

std::string ReadAllBytes(SkeletonInput& input) {
  constexpr size_t kMostBytes = size_t{1} << 30;  // a bound; by hand
  std::string bytes;
  std::array<char, 1 << 16> block{};
  while (input.stream.read(block.data(), block.size()) || input.stream.gcount() > 0) {
    bytes.append(block.data(), static_cast<size_t>(input.stream.gcount()));
    if (bytes.size() > kMostBytes) FailAtByte(input.name, bytes.size(), "at most 1 GiB");
  }
  return bytes;
}

}  // namespace ossa::recon
