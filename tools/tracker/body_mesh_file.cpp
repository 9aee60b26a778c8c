#include "tools/tracker/body_mesh_file.h"

#include "tools/tracker/shipped.h"

namespace ossa::tracker {

std::shared_ptr<const recon::BodyMesh> LoadBodyMesh(const std::string& surface_file,
                                                    const std::string& mesh_file) {
  const auto file = [](const std::string& named, const char* shipped) {
    return named.empty() ? ShippedFile(shipped) : std::filesystem::path(named);
  };
  const auto surface = recon::BodySurface::Load(file(surface_file, recon::kShippedSurface));
  return std::make_shared<const recon::BodyMesh>(
      recon::BodyMesh::Load(file(mesh_file, recon::kShippedMesh), surface));
}

}  // namespace ossa::tracker
