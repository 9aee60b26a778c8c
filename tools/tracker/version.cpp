#include "tools/tracker/tracker.h"

namespace ossa::tracker {

const char* Version() { return OSSA_VERSION; }

}  // namespace ossa::tracker
