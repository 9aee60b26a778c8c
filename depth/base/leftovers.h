#pragma once
#include <filesystem>

namespace ossa {

/// Removes what processes that were killed left of files (AtomicFile) in a folder and in those in
/// it: for a folder whose files are made anew, and where nobody on another machine writes, whose
/// locks may not be known here. What a process still writes stays. On file systems that know no
/// locks nobody can tell, and all stays.
void RemoveLeftovers(const std::filesystem::path& folder);

}  // namespace ossa
