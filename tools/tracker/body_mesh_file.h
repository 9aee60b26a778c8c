#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "recon/files/skeleton_writer.h"
#include "recon/fit/body_mesh.h"

namespace ossa::tracker {

/// Loads the skin of people in a .glb from files, "" for the shipped ones. Throws InputError if a
/// file is missing or damaged, or the mesh is for another surface.
std::shared_ptr<const recon::BodyMesh> LoadBodyMesh(const std::string& surface_file = "",
                                                    const std::string& mesh_file = "");

/// Choices for writing skeletons; "": the default of the format.
struct WriteChoice {
  std::string names;          // bone names of a .bvh or .glb: sdk, cmu, mixamo or vrm
  std::string surface, mesh;  // skin of a .glb, as in LoadBodyMesh; mesh "none": no skin
};

/// Loads the options for a file name. Throws InputError also for a choice that the format does not
/// support, and for a custom surface without its skin.
recon::SkeletonWriteOptions LoadWriteOptions(const std::filesystem::path& out,
                                             const WriteChoice& choice);

}  // namespace ossa::tracker
