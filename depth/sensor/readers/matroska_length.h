#pragma once
// Checks whether a Matroska recording is complete: libavformat returns the frames before a
// truncation without reporting it. RFC 8794 (EBML) and RFC 9559 (Matroska).
#include <istream>
#include <optional>
#include <string>

namespace ossa::depth {

/// A warning if the file ends before its segment does, or if its recorder never wrote the segment's
/// length. None if it is complete, or not Matroska.
std::optional<std::string> CheckForCut(std::istream& in);

}  // namespace ossa::depth
