#pragma once
#include <memory>
#include <string>

#include "recon/fit/body_mesh.h"

namespace ossa::tracker {

/// The skin that people of a .glb wear: of files, or "" for what ossa ships. Throws InputError
/// where a file is missing or damaged, or the mesh is another surface's.
std::shared_ptr<const recon::BodyMesh> LoadBodyMesh(const std::string& surface_file = "",
                                                    const std::string& mesh_file = "");

}  // namespace ossa::tracker
