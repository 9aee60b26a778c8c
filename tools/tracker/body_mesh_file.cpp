#include "tools/tracker/body_mesh_file.h"

#include <map>
#include <string_view>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "tools/tracker/shipped.h"

namespace ossa::tracker {
namespace {

recon::BvhNames ParseNames(const std::string& names, bool is_glb) {
  static const std::map<std::string_view, recon::BvhNames> kNames = {
      {"", recon::BvhNames::kSdk},
      {"sdk", recon::BvhNames::kSdk},
      {"cmu", recon::BvhNames::kCmu},
      {"mixamo", recon::BvhNames::kMixamo},
      {"vrm", recon::BvhNames::kVrm}};
  const auto known = kNames.find(names);
  if (known != kNames.end() && !(is_glb && names == "sdk")) return known->second;
  throw InputError(std::string("names: expected ") + (is_glb ? "" : "sdk, ") +
                   "cmu, mixamo or vrm, found '" + names + "'");
}

}  // namespace

std::shared_ptr<const recon::BodyMesh> LoadBodyMesh(const std::string& surface_file,
                                                    const std::string& mesh_file) {
  const auto file = [](const std::string& named, const char* shipped) {
    return named.empty() ? ShippedFile(shipped) : std::filesystem::path(named);
  };
  const auto surface = recon::BodySurface::Load(file(surface_file, recon::kShippedSurface));
  return std::make_shared<const recon::BodyMesh>(
      recon::BodyMesh::Load(file(mesh_file, recon::kShippedMesh), surface));
}

recon::SkeletonWriteOptions LoadWriteOptions(const std::filesystem::path& out,
                                             const WriteChoice& choice) {
  const std::string extension = LowerCaseExtension(out);
  const bool is_glb = extension == ".glb", is_bvh = extension == ".bvh";
  recon::SkeletonWriteOptions options;
  options.names = ParseNames(choice.names, is_glb);
  if (!choice.names.empty() && !is_glb && !is_bvh) {
    throw InputError("names: expected a .bvh or .glb with them, found " + out.string());
  }
  const bool has_skin = !choice.surface.empty() || !choice.mesh.empty();
  if (has_skin && !is_glb) {
    throw InputError("surface, mesh: expected a .glb with them, found " + out.string());
  }
  if (!choice.surface.empty() && choice.mesh.empty()) {
    throw InputError("surface: expected its skin with it, mesh, or mesh 'none', found " +
                     choice.surface + " alone");
  }
  if (is_glb && choice.mesh != "none") options.body = LoadBodyMesh(choice.surface, choice.mesh);
  return options;
}

}  // namespace ossa::tracker
