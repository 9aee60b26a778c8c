#pragma once
#include <filesystem>
#include <string_view>

namespace ossa::tracker {

/// The path of a shipped file (body.ossa, body_ceiling.ossa, body.ossagp, body.ossarefine,
/// body_ceiling.ossarefine, body.ossanet, kinect_v2.ossagp, authored.ossadb, posture.ossaprior,
/// body.ossasurface, body.ossamesh): in the folder that the environment variable OSSA_SHARE names,
/// else in ../share/ossa beside the running program, else in the source tree of the build. Throws
/// InputError that lists the searched folders.
std::filesystem::path ShippedFile(std::string_view name);

/// Whether `path` is the shipped file. False if there is no such file.
bool IsShippedFile(const std::filesystem::path& path, std::string_view name);

}  // namespace ossa::tracker
