#pragma once
#include <functional>

namespace ossa::depth {

/// OpenNI2 holds its lock while it shuts down and waits for its drivers to end; a driver's thread
/// that announces a device just then waits for that lock, and neither ever goes on. So our drivers
/// announce only through a gate that our sessions close for the time of a shutdown.
/// Process-wide, as OpenNI2 itself is.

/// Calls `announce` unless a shutdown is under way: then it returns false at once.
bool AnnounceUnlessShuttingDown(const std::function<void()>& announce);

/// Closes the gate; returns when no announcement is under way.
class ShutdownGateClosed {
 public:
  ShutdownGateClosed();
  ~ShutdownGateClosed();
  ShutdownGateClosed(const ShutdownGateClosed&) = delete;
  ShutdownGateClosed& operator=(const ShutdownGateClosed&) = delete;
};

}  // namespace ossa::depth
