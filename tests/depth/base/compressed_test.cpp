#include "depth/base/compressed.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "depth/base/checksummed_container.h"
#include "tests/support/refused.h"

namespace ossa {
namespace {

std::vector<std::byte> Steps() {
  std::vector<std::byte> bytes;
  for (int i = 0; i < 1000; ++i) bytes.push_back(static_cast<std::byte>(i / 10));
  return bytes;
}

TEST(Compressed, RoundTripIsExactAndSmaller) {
  for (const int level : {3, 19}) {
    const std::vector<std::byte> fewer = Compress(Steps(), level);
    EXPECT_LT(fewer.size(), 500U);
    EXPECT_EQ(Decompress(fewer, "x", "thing"), Steps());
  }
  EXPECT_TRUE(Decompress(Compress({}, 3), "x", "thing").empty());
}

// Other damage is detected by the file's checksum.
TEST(Compressed, OtherDataAreRefusedByName) {
  constexpr size_t kFrame = 2 * sizeof(uint64_t);  // after two lengths
  std::vector<std::byte> damaged = Compress(Steps(), 3);
  damaged[kFrame] ^= std::byte{0xff};
  test::ExpectRefused([&] { Decompress(damaged, "x.file", "thing"); }, "x.file");
  damaged = Compress(Steps(), 3);
  damaged.pop_back();
  test::ExpectRefused([&] { Decompress(damaged, "x.file", "thing"); }, "compressed payload");
}

TEST(Compressed, HugeLengthsAreRefused) {
  for (const uint64_t size : {uint64_t{999}, uint64_t{1001}, uint64_t{1} << 31U, ~uint64_t{0}}) {
    std::vector<std::byte> lying = Compress(Steps(), 3);
    std::memcpy(lying.data(), &size, sizeof(size));
    test::ExpectRefused([&] { Decompress(lying, "x.file", "thing"); }, "x.file");
  }
}

std::vector<std::byte> Noise(size_t size) {
  std::mt19937 random(1);
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

// Refused before allocation, not as damaged data.
TEST(Compressed, ImplausibleLengthIsRefused) {
  std::vector<std::byte> lying = Compress(Noise(8000), 3);
  for (const uint64_t size : {uint64_t{1} << 30U, uint64_t{8001}}) {
    std::memcpy(lying.data(), &size, sizeof(size));
    test::ExpectRefused([&] { Decompress(lying, "x.file", "thing"); }, "unpacked length");
  }
}

TEST(Compressed, MostCompressibleDataAreAccepted) {
  const std::vector<std::byte> zeros(size_t{1} << 26U);
  EXPECT_EQ(Decompress(Compress(zeros, 3), "x", "thing"), zeros);
}

}  // namespace
}  // namespace ossa
