#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ossa {

/// A payload as checksummed containers keep it compressed: its length, then the bytes that zstd
/// makes of it; at higher levels (to 19) it takes longer and these are fewer.
std::vector<std::byte> Compress(std::span<const std::byte> payload, int level);

/// The payload of `what` in the file. Throws InputError that names both where the length is absurd
/// (nothing is allocated for it) or the bytes are damaged.
std::vector<std::byte> Decompress(std::span<const std::byte> compressed, const std::string& file,
                                  std::string_view what);

}  // namespace ossa
