#pragma once
#include <filesystem>
#include <string_view>

namespace ossa::tracker {

/// A file that comes with ossa (body.ossa, body_ceiling.ossa, body.ossagp, body.ossarefine,
/// body_ceiling.ossarefine, body.ossanet, kinect_v2.ossagp, authored.ossadb, posture.ossaprior,
/// body.ossasurface, body.ossamesh): in the folder the environment variable OSSA_SHARE names, else
/// in ../share/ossa beside the running program, else in the source tree it was built from. Throws
/// InputError that says where it was looked for.
std::filesystem::path ShippedFile(std::string_view name);

/// Is `path` that very file? False as well when there is no such file.
bool IsShippedFile(const std::filesystem::path& path, std::string_view name);

}  // namespace ossa::tracker
