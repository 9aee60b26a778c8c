#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "recon/body/rig.h"
#include "recon/files/skeleton_io.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {

/// Prints the readers' warnings to stderr, a line each: "COMMAND: warning: FILE: ...". Also when
/// quiet, because they concern the result. After the first twenty only the number of the others.
void PrintWarnings(std::string_view command, const std::vector<recon::SkeletonClip>& clips);
void PrintWarnings(std::string_view command, const std::vector<recon::MotionClip>& clips);
void PrintWarnings(std::string_view command, const std::vector<std::string>& warnings);

/// Prints what a tracker noticed in the frames of a source, as above.
void PrintWarning(std::string_view command, const std::string& source, tracker::Tracker& tracker);

}  // namespace ossa::commands
