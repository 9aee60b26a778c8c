#pragma once
#include <string_view>
#include <vector>

#include "recon/body/rig.h"
#include "recon/files/skeleton_io.h"

namespace ossa::commands {

/// Says on stderr what was odd in the files read and how it was taken, a line each: "COMMAND:
/// warning: FILE: ...". Also when quiet: what is said is of the result, not of the progress. Of a
/// folder full of oddities the first twenty, then how many more.
void SayWarnings(std::string_view command, const std::vector<recon::SkeletonClip>& clips);
void SayWarnings(std::string_view command, const std::vector<recon::MotionClip>& clips);
void SayWarnings(std::string_view command, const std::vector<std::string>& warnings);

}  // namespace ossa::commands
