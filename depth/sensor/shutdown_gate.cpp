#include "depth/sensor/shutdown_gate_internal.h"

#include <mutex>

namespace ossa::depth {
namespace {

struct Gate {
  std::mutex mutex;
  int closed = 0;  // number of closers
};

Gate& TheGate() {
  static Gate gate;
  return gate;
}

}  // namespace

bool AnnounceUnlessShuttingDown(const std::function<void()>& announce) {
  Gate& gate = TheGate();
  const std::lock_guard lock(gate.mutex);
  if (gate.closed > 0) return false;
  announce();
  return true;
}

ShutdownGateClosed::ShutdownGateClosed() {
  const std::lock_guard lock(TheGate().mutex);
  ++TheGate().closed;
}

ShutdownGateClosed::~ShutdownGateClosed() {
  const std::lock_guard lock(TheGate().mutex);
  --TheGate().closed;
}

}  // namespace ossa::depth
