#pragma once
#include <memory>
#include <string>
#include <vector>

#include "tools/stream/target.h"
#include "tools/tracker/tracker.h"

namespace ossa::stream {

/// Sends skeletons to other programs as they are tracked, by UDP: a datagram that cannot leave at
/// once is dropped, and whether anybody listens makes no difference. Used from one thread at a
/// time.
class Sender {
 public:
  /// Throws InputError where a host has no address.
  explicit Sender(const std::vector<Target>& targets);
  ~Sender();
  Sender(Sender&&) noexcept;
  Sender& operator=(Sender&&) noexcept;

  /// The frame to everybody. Of several people VMC gets the first at its port, the second at the
  /// next one and so on, each as long as they stay; VRChat gets the first, and two seconds after
  /// they left the next.
  void Send(const tracker::BodyFrame& frame);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace ossa::stream
