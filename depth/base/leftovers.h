#pragma once
#include <filesystem>

namespace ossa {

/// Removes what processes that were killed left of files (AtomicFile) in a folder and in those in
/// it: for a folder whose files are made anew, and where nobody on another machine writes, whose
/// locks may not be known here. What a process still writes stays. On file systems that know no
/// locks nobody can tell, and all stays.
void RemoveLeftovers(const std::filesystem::path& folder);

/// The same of what was to become this one file: of files that are worth nothing when they are cut.
void RemoveLeftoversOf(const std::filesystem::path& final_path);

}  // namespace ossa
