#include "depth/base/compressed.h"

#include <zstd.h>

#include <cstdint>

#include "depth/base/checksummed_container.h"
#include "depth/base/error.h"
#include "depth/base/large_pages.h"

namespace ossa {

std::vector<std::byte> Compress(std::span<const std::byte> payload, int level) {
  std::vector<std::byte> bytes(ZSTD_compressBound(payload.size()));
  bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), payload.data(), payload.size(), level));
  PayloadWriter out;
  out.Put<uint64_t>(payload.size());
  out.PutVector(bytes);
  return out.bytes();
}

std::vector<std::byte> Decompress(std::span<const std::byte> compressed, const std::string& file,
                                  std::string_view what) {
  PayloadReader in(compressed, file);
  const auto size = in.Get<uint64_t>("unpacked length");
  const auto bytes = in.GetBytes("compressed payload");
  in.ExpectEnd();
  // The shortest zstd block, 4 bytes, expands to at most 2^17 equal bytes, and frames that we write
  // state their content size: larger claims are refused before allocating.
  constexpr uint64_t kMost = uint64_t{1} << 31U;       // bytes; bound
  constexpr uint64_t kMostTimes = uint64_t{1} << 15U;  // derived: 2^17 over 4
  const uint64_t frame_size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  const bool is_frame =
      frame_size != ZSTD_CONTENTSIZE_ERROR;  // else damaged, which is reported below
  if (size > kMost || size / kMostTimes > bytes.size() || (is_frame && size != frame_size)) {
    throw InputError(file + ": byte 32: unpacked length: " + std::to_string(size) +
                     " is more than the file can hold");
  }
  auto payload = MakeLargeVector<std::byte>(size);
  const size_t got = ZSTD_decompress(payload.data(), payload.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) != 0 || got != size) {
    throw InputError(file + ": byte 40: compressed payload: the " + std::string(what) +
                     " is damaged");
  }
  return payload;
}

}  // namespace ossa
