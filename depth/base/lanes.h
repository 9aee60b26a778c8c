#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace ossa {

/// Number of SIMD lanes: the same on every machine, so that sums over lanes have the same order and
/// the same bits.
inline constexpr size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using IntLanes = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

/// The count rounded up to a multiple of kLanes.
inline size_t PaddedToLanes(size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// Loads lanes from memory of any alignment.
[[gnu::always_inline]] inline void LoadLanes(const float* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

/// Writes the indices of the values that are at least `least`, in order, and returns their number;
/// `picked` needs room for all. Branch-free, because the outcomes are unpredictable.
inline size_t PickAtLeast(float least, const float* value, size_t count, uint32_t* picked) {
  size_t kept = 0;
  for (size_t i = 0; i < count; ++i) {
    picked[kept] = static_cast<uint32_t>(i);
    kept += value[i] >= least ? 1 : 0;
  }
  return kept;
}

}  // namespace ossa
