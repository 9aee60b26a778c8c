#include "depth/sensor/readers/ros/packed_bytes.h"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <new>
#include <string>

#include "depth/base/error.h"

namespace ossa::depth {
namespace {

struct FreeLz4 {
  void operator()(LZ4F_dctx* decoder) const { LZ4F_freeDecompressionContext(decoder); }
};

std::unique_ptr<LZ4F_dctx, FreeLz4> MakeLz4() {
  LZ4F_dctx* decoder = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&decoder, LZ4F_VERSION))) throw std::bad_alloc();
  return std::unique_ptr<LZ4F_dctx, FreeLz4>(decoder);
}

}  // namespace

void CheckUnpackedSize(uint64_t size) {
  constexpr uint64_t kMost = uint64_t{1} << 29;  // bytes; by hand: four of the largest images
  if (size <= kMost) return;
  throw InputError("expected at most " + std::to_string(kMost) + " bytes, found " +
                   std::to_string(size) + " in one piece");
}

bool IsZstd(std::span<const uint8_t> bytes) {
  constexpr std::array<uint8_t, 4> kMagic = {0x28, 0xB5, 0x2F, 0xFD};
  return bytes.size() >= kMagic.size() && std::equal(kMagic.begin(), kMagic.end(), bytes.begin());
}

std::vector<uint8_t> UnpackZstd(std::span<const uint8_t> bytes, uint64_t size) {
  CheckUnpackedSize(size);
  std::vector<uint8_t> unpacked(size);
  const size_t got = ZSTD_decompress(unpacked.data(), unpacked.size(), bytes.data(), bytes.size());
  if (ZSTD_isError(got) || got != unpacked.size()) {
    throw InputError("expected Zstandard of " + std::to_string(size) + " bytes, found damage");
  }
  return unpacked;
}

std::vector<uint8_t> UnpackZstd(std::span<const uint8_t> bytes) {
  const auto size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN) {
    throw InputError("expected Zstandard that states its size, found none");
  }
  return UnpackZstd(bytes, size);
}

std::vector<uint8_t> UnpackLz4(std::span<const uint8_t> bytes, uint64_t size) {
  CheckUnpackedSize(size);
  std::vector<uint8_t> unpacked(size);
  const auto decoder = MakeLz4();
  size_t filled = 0;
  for (size_t taken = 0; taken < bytes.size();) {
    size_t room = size - filled, left = bytes.size() - taken;
    const size_t hint = LZ4F_decompress(decoder.get(), unpacked.data() + filled, &room,
                                        bytes.data() + taken, &left, nullptr);
    filled += room;
    taken += left;
    if (LZ4F_isError(hint)) throw InputError("expected LZ4, found damaged bytes");
    if (hint == 0 || (room == 0 && left == 0)) break;
  }
  if (filled != size) {
    throw InputError("expected LZ4 of " + std::to_string(size) + " bytes, found " +
                     std::to_string(filled));
  }
  return unpacked;
}

}  // namespace ossa::depth
