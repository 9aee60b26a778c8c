// Where liboscpack-dev was not installed: OSC is refused when it is asked for.
#include "depth/base/error.h"
#include "tools/stream/packets.h"

namespace ossa::stream {
namespace {

[[noreturn]] void Refuse() {
  throw InputError("--send: this ossa was built without liboscpack: expected udp://HOST:PORT");
}

}  // namespace

std::string VmcPacket(const Humanoid&, double, bool) { Refuse(); }
std::string VrchatPacket(const Humanoid&, double) { Refuse(); }
void CheckHasOsc() { Refuse(); }

}  // namespace ossa::stream
