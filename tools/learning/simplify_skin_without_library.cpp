#include "depth/base/error.h"
#include "tools/learning/simplify_skin.h"

namespace ossa::tools {

SimplifiedSkin SimplifySkin(const recon::BodyModel& /*model*/, size_t /*triangles*/) {
  throw InputError("surface: --mesh is left out of this ossa: it was built without meshoptimizer");
}

}  // namespace ossa::tools
