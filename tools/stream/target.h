#pragma once
#include <string>

namespace ossa::stream {

inline constexpr int kMostPort = 65535;  // by definition of UDP

/// Who understands what is sent.
enum class Protocol {
  kVmc,     // Virtual Motion Capture: avatars' programs
  kVrchat,  // VRChat's OSC trackers
  kJsonl,   // anybody: a line of skeleton JSONL a datagram
};

/// Where skeletons are sent to.
struct Target {
  std::string url;  // as it was given
  Protocol protocol = Protocol::kJsonl;
  std::string host;
  int port = 0;
  /// Lengths are multiplied by it: a receiver who thinks that the person is taller or smaller.
  double scale = 1.0;  // factor, by definition
  /// VMC: only the bones that are seen, none at rest: fingers and eyes are another performer's.
  bool seen_only = false;
};

/// vmc://HOST[:39539][?bones=all|seen], vrchat://HOST[:9000][?scale=X] or udp://HOST:PORT; an IPv6
/// address stands in brackets. Throws InputError naming the URL and what was expected.
Target ParseTarget(const std::string& url);

}  // namespace ossa::stream
