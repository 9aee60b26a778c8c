#pragma once
#include <string>
#include <string_view>

namespace ossa::recon {

/// For a file that no reader recognises: its format, if known by its first bytes, and how to
/// convert it ("FBX: export it as BVH"). Else empty.
std::string DescribeForeignRecording(std::string_view head);

}  // namespace ossa::recon
