#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace ossa {

/// Numbers that are computed side by side. As many on every machine, so that sums over lanes have
/// the same order and the same bits on each.
inline constexpr size_t kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using IntLanes = int32_t __attribute__((vector_size(kLanes * sizeof(int32_t))));

/// The next count that fills all lanes.
inline size_t PaddedToLanes(size_t count) { return (count + kLanes - 1) / kLanes * kLanes; }

/// Lanes from memory of any alignment.
[[gnu::always_inline]] inline void LoadLanes(const float* from, Lanes* to) {
  std::memcpy(to, from, sizeof(Lanes));
}

/// Writes the numbers of the values that are at least `least`, in order, and returns how many; room
/// for all of them is needed. Without a branch, for which ones hardly anybody foresees.
inline size_t PickAtLeast(float least, const float* value, size_t count, uint32_t* picked) {
  size_t kept = 0;
  for (size_t i = 0; i < count; ++i) {
    picked[kept] = static_cast<uint32_t>(i);
    kept += value[i] >= least ? 1 : 0;
  }
  return kept;
}

}  // namespace ossa
