#pragma once
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace ossa::tools {

/// A small seeded generator (SplitMix64): the same numbers on every machine and library, which the
/// standard distributions do not promise. Frame i of a data set draws from Random(seed, i) alone.
class Random {
 public:
  explicit Random(uint64_t seed, uint64_t stream = 0) : state_(seed) {
    state_ = Bits() ^ (stream * 0xD1342543DE82EF95ULL);
    Bits();
  }

  uint64_t Bits() {
    state_ += 0x9E3779B97F4A7C15ULL;
    uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ULL;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBULL;
    return x ^ (x >> 31);
  }

  /// In [low, high).
  double Uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(Bits() >> 11) * 0x1.0p-53;
  }

  /// In [0, count); count > 0.
  size_t Index(size_t count) {
    return static_cast<size_t>(Uniform(0.0, static_cast<double>(count)));
  }

  bool Chance(double share) { return Uniform(0.0, 1.0) < share; }

  /// Normal by Box and Muller.
  double Normal(double mean, double deviation) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - Uniform(0.0, 1.0)));
    return mean + deviation * radius * std::cos(Uniform(0.0, 2.0 * std::numbers::pi));
  }

 private:
  uint64_t state_;
};

}  // namespace ossa::tools
