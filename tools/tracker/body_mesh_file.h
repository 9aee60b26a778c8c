#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "recon/files/skeleton_writer.h"
#include "recon/fit/body_mesh.h"

namespace ossa::tracker {

/// The skin that people of a .glb wear: of files, or "" for what ossa ships. Throws InputError
/// where a file is missing or damaged, or the mesh is another surface's.
std::shared_ptr<const recon::BodyMesh> LoadBodyMesh(const std::string& surface_file = "",
                                                    const std::string& mesh_file = "");

/// How skeletons are written, by names and files; "": what is usual of the format.
struct WriteChoice {
  std::string names;          // of a .bvh or .glb: sdk, cmu, mixamo or vrm
  std::string surface, mesh;  // of a .glb: the skin, as LoadBodyMesh has it; mesh "none": no skin
};

/// Reads what a file of that name wants. Throws InputError also for a choice that the format does
/// not have, and for a surface of one's own without its skin.
recon::SkeletonWriteOptions LoadWriteOptions(const std::filesystem::path& out,
                                             const WriteChoice& choice);

}  // namespace ossa::tracker
