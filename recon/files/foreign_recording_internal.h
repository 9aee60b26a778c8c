#pragma once
#include <string>
#include <string_view>

namespace ossa::recon {

/// What a file is that no format recognises, where other programs' files of motion or of joints are
/// known by their beginning, and how to have it read: "FBX: export it as BVH". Else empty.
std::string DescribeForeignRecording(std::string_view head);

}  // namespace ossa::recon
