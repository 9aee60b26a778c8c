#pragma once
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

#include "recon/files/skeleton_formats_internal.h"

namespace ossa::recon {

/// Throws InputError "NAME: byte N: expected EXPECTED".
[[noreturn]] void FailAtByte(const std::string& name, size_t byte, const std::string& expected);

/// All there is, 1 GiB at most.
std::string ReadAllBytes(SkeletonInput& input);

/// A little-endian value; the caller has checked that its bytes are there.
template <typename T>
T ValueAt(std::string_view bytes, size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace ossa::recon
