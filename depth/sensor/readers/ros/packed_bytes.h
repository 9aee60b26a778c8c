#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ossa::depth {

/// Whether these are a frame of Zstandard (RFC 8878).
bool IsZstd(std::span<const uint8_t> bytes);

/// Decompresses Zstandard to `size` bytes. Throws InputError.
std::vector<uint8_t> UnpackZstd(std::span<const uint8_t> bytes, uint64_t size);

/// The same of one frame, whose header states its size.
std::vector<uint8_t> UnpackZstd(std::span<const uint8_t> bytes);

/// Decompresses a frame of LZ4 to `size` bytes. Throws InputError.
std::vector<uint8_t> UnpackLz4(std::span<const uint8_t> bytes, uint64_t size);

/// Throws InputError if `size` bytes are more than any message or chunk of images has.
void CheckUnpackedSize(uint64_t size);

}  // namespace ossa::depth
