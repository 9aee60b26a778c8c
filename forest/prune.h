#pragma once
#include <cstdint>

#include "forest/forest.h"

namespace ossa::forest {

enum class Packing { kFile, kQuick };

/// The size of the file of such a model; kQuick: packed less tightly, in a tenth of the time.
uint64_t FileSize(const ForestData& data, Packing packing = Packing::kFile);

/// The model with the rarest entries of its leaves left out until its file fits: entries of less
/// than a bound of their leaf's largest, the same bound in every leaf, no higher than needed.
/// Throws InputError when even leaves of one entry do not fit.
ForestModel FitInto(const ForestModel& model, uint64_t bytes);

}  // namespace ossa::forest
