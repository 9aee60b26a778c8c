#pragma once
#include <cstdint>

namespace ossa::forest {

/// SplitMix64: a stream is fixed by its seed; independent of platform and library.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}

  uint64_t Next() {
    state_ += 0x9e3779b97f4a7c15ULL;
    uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  /// In [0, bound), bound > 0; the bias of 2^-32 · bound is of no matter here.
  uint32_t Below(uint32_t bound) { return static_cast<uint32_t>(((Next() >> 32U) * bound) >> 32U); }
  double Unit() { return static_cast<double>(Next() >> 11U) * 0x1.0p-53; }

 private:
  uint64_t state_;
};

/// One seed out of several numbers.
inline uint64_t MixSeed(uint64_t a, uint64_t b, uint64_t c = 0, uint64_t d = 0) {
  uint64_t mixed = Random(a).Next();
  mixed = Random(mixed ^ b).Next();
  mixed = Random(mixed ^ c).Next();
  return Random(mixed ^ d).Next();
}

}  // namespace ossa::forest
