#pragma once

namespace ossa::depth {

/// Between OpenNI2's initialize and shutdown, which OpenNI2 counts. Drivers of ours announce no
/// device while one ends, so that neither waits for the other.
class OpenNiSession {
 public:
  OpenNiSession();  // throws InputError when OpenNI2 or its drivers cannot be loaded
  ~OpenNiSession();
  OpenNiSession(const OpenNiSession&) = delete;
  OpenNiSession& operator=(const OpenNiSession&) = delete;
};

}  // namespace ossa::depth
