#pragma once
#include <cstdint>
#include <functional>

namespace ossa::commands {

/// A bar for whoever watches a terminal while files are read, for
/// recon::SkeletonReadOptions::progress: one for each file, folder or archive that takes longer
/// than a moment. Nothing when quiet or where no terminal is.
std::function<void(uint64_t done, uint64_t of)> ReadingBar(bool quiet);

}  // namespace ossa::commands
