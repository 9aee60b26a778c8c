#pragma once
#include <string>
#include <string_view>

#include "recon/skeleton_sequence.h"

namespace ossa::tools {

/// Converts a skeleton sequence to JSONL and back, for the caches of studies.
std::string FormatSequence(const recon::SkeletonSequence& sequence);
recon::SkeletonSequence ParseSequence(const std::string& text, const std::string& name);

/// Separator of sequences in a cached text; it never occurs in JSONL.
inline constexpr std::string_view kSequenceEnd = "---\n";

}  // namespace ossa::tools
