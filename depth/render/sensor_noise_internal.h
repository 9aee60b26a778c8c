#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "depth/base/random.h"

namespace ossa::depth {

// Noise of simulated sensors; it depends on seed and position, not on the order of evaluation.

/// 64 random bits of a position.
inline uint64_t Hash(uint64_t seed, uint64_t place) { return Random::BitsAt(seed, place); }

/// 16 bits of a hash as a number in [0, 1).
inline float Uniform(uint64_t hash, int lane) {
  return static_cast<float>((hash >> (16 * lane)) & 0xFFFF) * (1.0F / 65536.0F);
}

/// Nearly standard normal: a sum of four numbers in [0, 1) has variance 4 / 12.
inline float Normal(uint64_t hash) {
  const float sum = static_cast<float>(SumOfParts(hash)) * (1.0F / 65536.0F);
  return (sum - 2.0F) * 1.7320508F;
}

inline int Rounded(float value) { return static_cast<int>(std::floor(value + 0.5F)); }

/// Spatially correlated normal noise: a coarse grid, interpolated between its nodes.
class WavyNoise {
 public:
  WavyNoise(int width, int height, float cell_px, uint64_t seed)
      : columns_(static_cast<int>(static_cast<float>(width) / cell_px) + 2),
        scale_(1.0F / cell_px) {
    const int rows = static_cast<int>(static_cast<float>(height) / cell_px) + 2;
    for (int i = 0; i < columns_ * rows; ++i) {
      nodes_.push_back(Normal(Hash(seed, static_cast<uint64_t>(i))));
    }
  }
  float At(int u, int v) const {
    // Interpolation reduces the variance to 4/9 on average; factor; derived: sqrt(9/4)
    constexpr float kRestore = 1.5F;
    const float x = static_cast<float>(u) * scale_;
    const float y = static_cast<float>(v) * scale_;
    const int column = static_cast<int>(x);
    const int row = static_cast<int>(y);
    const float fx = x - static_cast<float>(column);
    const float fy = y - static_cast<float>(row);
    const float* node = nodes_.data() + static_cast<ptrdiff_t>(row) * columns_ + column;
    const float top = node[0] + fx * (node[1] - node[0]);
    const float bottom = node[columns_] + fx * (node[columns_ + 1] - node[columns_]);
    return kRestore * (top + fy * (bottom - top));
  }

 private:
  int columns_;
  float scale_;
  std::vector<float> nodes_;
};

}  // namespace ossa::depth
