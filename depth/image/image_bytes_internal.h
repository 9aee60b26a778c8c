#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace ossa::depth {

/// The first bytes of an image file, `at_most` of them. Throws InputError if it cannot be read or
/// is larger than any image.
std::vector<uint8_t> ReadImageBytes(const std::filesystem::path& path, size_t at_most);
std::vector<uint8_t> ReadImageBytes(const std::filesystem::path& path);

}  // namespace ossa::depth
