#include "tools/tracker/version.h"

namespace ossa::tracker {

const char* Version() { return OSSA_VERSION; }

}  // namespace ossa::tracker
