#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace ossa {

/// A small seeded generator, SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every
/// machine and library, unlike the standard distributions.
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  /// Stream number `stream` of a seed: frame i of a data set draws from Random(seed, i) alone.
  Random(uint64_t seed, uint64_t stream) : state_(seed) {
    state_ = Bits() ^ (stream * 0xd1342543de82ef95ULL);
    Bits();
  }

  /// The number at `index` (from 0) of a seed's sequence, whatever was drawn before.
  static uint64_t BitsAt(uint64_t seed, uint64_t index) {
    return Random(seed + index * kIncrement).Bits();
  }

  uint64_t Bits() {
    state_ += kIncrement;
    uint64_t z = state_;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31U);
  }
  /// In [0, 1).
  double Unit() { return static_cast<double>(Bits() >> 11U) * 0x1.0p-53; }
  /// In [low, high).
  double Uniform(double low, double high) { return low + (high - low) * Unit(); }
  /// In [0, bound), bound > 0; the bias of 2^-32 · bound is negligible.
  uint32_t Below(uint32_t bound) { return static_cast<uint32_t>(((Bits() >> 32U) * bound) >> 32U); }
  /// In [0, count); count > 0. A different sequence from Below.
  size_t Index(size_t count) {
    return static_cast<size_t>(Uniform(0.0, static_cast<double>(count)));
  }
  /// True with probability `share`.
  bool Chance(double share) { return Unit() < share; }
  /// Normally distributed (Box and Muller).
  double Normal(double mean, double deviation) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Unit()));
    return mean + deviation * radius * std::cos(Uniform(0.0, 2.0 * std::numbers::pi));
  }

 private:
  static constexpr uint64_t kIncrement = 0x9e3779b97f4a7c15ULL;  // Steele, Lea and Flood 2014

  uint64_t state_;
};

/// Sum of the four 16-bit parts of 64 random bits: nearly normally distributed (Irwin-Hall), with
/// mean 2 (2^16 - 1) and variance (2^32 - 1) / 3. It is cheaper than Random::Normal and bounded.
inline int SumOfParts(uint64_t bits) {
  int sum = 0;
  for (int part = 0; part < 4; ++part) sum += static_cast<int>((bits >> (16 * part)) & 0xFFFF);
  return sum;
}

/// SumOfParts with mean 0 and variance 1.
inline double NearlyNormal(uint64_t bits) {
  constexpr double kMean = 2.0 * 0xFFFF;       // no unit; derived: of SumOfParts
  constexpr double kDeviation = 37837.227237;  // no unit; derived: the root of its variance
  return (SumOfParts(bits) - kMean) / kDeviation;
}

/// Combines several numbers into one seed.
inline uint64_t MixSeed(uint64_t a, uint64_t b, uint64_t c = 0, uint64_t d = 0) {
  uint64_t mixed = Random(a).Bits();
  mixed = Random(mixed ^ b).Bits();
  mixed = Random(mixed ^ c).Bits();
  return Random(mixed ^ d).Bits();
}

}  // namespace ossa
