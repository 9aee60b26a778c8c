#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ossa {

/// A payload compressed for checksummed containers: its length, then zstd data. Higher levels (up
/// to 19) take longer and give fewer bytes.
std::vector<std::byte> Compress(std::span<const std::byte> payload, int level);

/// Decompresses the payload of `what` in `file`. Throws InputError that names both if the length is
/// implausible (nothing is allocated for it) or the data are damaged.
std::vector<std::byte> Decompress(std::span<const std::byte> compressed, const std::string& file,
                                  std::string_view what);

}  // namespace ossa
