#include "depth/base/error.h"
#include "recon/files/skeleton_writer_internal.h"

namespace ossa::recon {

std::unique_ptr<SkeletonWriter::Format> NewGltfWriter(const std::filesystem::path& path,
                                                      const SkeletonWriteOptions& /*options*/) {
  throw InputError(path.string() +
                   ": .glb is left out of this ossa: it was built without tinygltf");
}

}  // namespace ossa::recon
