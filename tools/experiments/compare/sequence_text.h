#pragma once
#include <string>
#include <string_view>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// A skeleton sequence as JSONL and back, for the caches of studies.
std::string FormatSequence(const recon::SkeletonSequence& sequence);
recon::SkeletonSequence ParseSequence(const std::string& text, const std::string& name);

/// Between two sequences in one cached text; no JSONL holds it.
inline constexpr std::string_view kSequenceEnd = "---\n";

}  // namespace ossa::tools
