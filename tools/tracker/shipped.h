#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace ossa::recon {
struct PosturePrior;
}

namespace ossa::tracker {

/// A file that comes with ossa (body.ossa, body.ossagp, body.ossalook, kinect_v2.ossagp,
/// authored.ossadb, posture.ossaprior): in the folder the environment variable OSSA_SHARE names,
/// else in
/// ../share/ossa beside the running program, else in the source tree it was built from. Throws
/// InputError that says where it was looked for.
std::filesystem::path ShippedFile(std::string_view name);

/// Is `path` that very file? False as well when there is no such file.
bool IsShippedFile(const std::filesystem::path& path, std::string_view name);

/// What `method` completes postures by: null but for best; the prior that was named, else the
/// shipped one, unless a database was named ("": it was not). Throws InputError.
std::shared_ptr<const recon::PosturePrior> PriorFor(const std::string& method,
                                                    const std::string& prior,
                                                    const std::string& database);

}  // namespace ossa::tracker
