#pragma once
#include <cstdint>

#include "forest/forest.h"

namespace ossa::forest {

enum class Packing { kFile, kQuick };

/// The file size of the model; kQuick: with weaker compression, in a tenth of the time.
uint64_t FileSize(const ForestData& data, Packing packing = Packing::kFile);

/// Prunes the smallest leaf entries until the model's file fits: entries below a fraction of their
/// leaf's largest, with the same fraction for all leaves, as small as possible. Throws InputError
/// if leaves of one entry still do not fit.
ForestModel FitInto(const ForestModel& model, uint64_t bytes);

}  // namespace ossa::forest
