#pragma once
#include <cstdint>
#include <functional>

namespace ossa::commands {

/// A progress bar for reading files, for recon::SkeletonReadOptions::progress: one for each file,
/// folder or archive that takes longer than half a second. Nothing when quiet or without a
/// terminal.
std::function<void(uint64_t done, uint64_t of)> ReadingBar(bool quiet);

}  // namespace ossa::commands
