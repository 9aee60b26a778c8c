#pragma once
#include <filesystem>

namespace ossa {

/// Removes the leftovers of killed processes (AtomicFile) in a folder and its sub-folders: for a
/// folder whose files are made anew and to which no other machine, whose locks may be invisible
/// here, writes. Files still being written are kept. On file systems without locks nothing is
/// removed.
void RemoveLeftovers(const std::filesystem::path& folder);

/// As RemoveLeftovers, for one file: for files that are useless when incomplete.
void RemoveLeftoversOf(const std::filesystem::path& final_path);

}  // namespace ossa
