#pragma once
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {

/// Throws InputError "NAME: byte N: expected EXPECTED".
[[noreturn]] void FailAtByte(const std::string& name, size_t byte, const std::string& expected);

/// The rest of the input, 1 GiB at most.
std::string ReadAllBytes(SkeletonInput& input);

/// A little-endian value. The caller has checked that enough bytes are left.
template <typename T>
T ValueAt(std::string_view bytes, size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace ossa::recon
