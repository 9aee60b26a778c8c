#pragma once
#include <functional>

namespace ossa::depth {

/// OpenNI2 holds its lock while it shuts down and waits for its drivers; a driver thread that
/// announces a device at that moment waits for the lock: a deadlock. So our drivers announce only
/// through a gate that our sessions close during a shutdown. Process-wide, as OpenNI2 is. Calls
/// `announce` unless a shutdown is in progress: then it returns false at once.

/// Calls `announce` unless a shutdown is under way: then it returns false at once.
bool AnnounceUnlessShuttingDown(const std::function<void()>& announce);

/// Closes the gate; blocks until no announcement is in progress.
class ShutdownGateClosed {
 public:
  ShutdownGateClosed();
  ~ShutdownGateClosed();
  ShutdownGateClosed(const ShutdownGateClosed&) = delete;
  ShutdownGateClosed& operator=(const ShutdownGateClosed&) = delete;
};

}  // namespace ossa::depth
