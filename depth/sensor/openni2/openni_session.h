#pragma once

namespace ossa::depth {

/// Initialises OpenNI2 and shuts it down (reference-counted by OpenNI2). During a shutdown our
/// drivers announce no devices, to avoid a deadlock.
class OpenNiSession {
 public:
  OpenNiSession();  // throws InputError if OpenNI2 or its drivers cannot be loaded
  ~OpenNiSession();
  OpenNiSession(const OpenNiSession&) = delete;
  OpenNiSession& operator=(const OpenNiSession&) = delete;
};

}  // namespace ossa::depth
