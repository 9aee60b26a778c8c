#pragma once
#include <string>

namespace ossa::stream {

inline constexpr int kMostPort = 65535;  // by definition of UDP

/// Protocol of the receiver.
enum class Protocol {
  kVmc,     // Virtual Motion Capture, for avatars
  kVrchat,  // VRChat's OSC trackers
  kJsonl,   // a line of skeleton JSONL per datagram
};

/// Destination of skeletons.
struct Target {
  std::string url;  // as given
  Protocol protocol = Protocol::kJsonl;
  std::string host;
  int port = 0;
  /// Factor of all lengths, for receivers that assume another body height.
  double scale = 1.0;  // factor, by definition
  /// VMC: send estimated bones only, because fingers and eyes come from another sender.
  bool seen_only = false;
};

/// vmc://HOST[:39539][?bones=all|seen], vrchat://HOST[:9000][?scale=X] or udp://HOST:PORT; IPv6
/// addresses in brackets. Throws InputError naming the URL and what was expected.
Target ParseTarget(const std::string& url);

}  // namespace ossa::stream
