#pragma once
// Whether a Matroska recording has all the bytes that its head counts: libavformat gives the frames
// before a cut and does not say that there were more. RFC 8794 (EBML) and RFC 9559 (Matroska).
#include <istream>
#include <optional>
#include <string>

namespace ossa::depth {

/// What to warn of: that the file ends before its one segment does, or that its recorder never
/// wrote how long the segment is. Nothing where it is whole, or where it is no Matroska.
std::optional<std::string> CheckForCut(std::istream& in);

}  // namespace ossa::depth
