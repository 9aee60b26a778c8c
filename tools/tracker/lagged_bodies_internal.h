#pragma once
#include <deque>
#include <map>
#include <optional>

#include "recon/filters/lag_smoothing.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// A delay line that smooths joints over the frames before and after. Every frame that goes in
/// comes out once, in order, with its own index and time.
class LaggedBodies {
 public:
  explicit LaggedBodies(const recon::LagOptions& options) : options_(options) {}
  /// Adds a frame; returns the oldest held one once the lag is full.
  std::optional<BodyFrame> Add(BodyFrame frame);
  /// At the end of a stream: the oldest held frame, smoothed with the available ones; nothing when
  /// all were returned. Frames added afterwards belong to another stream.
  std::optional<BodyFrame> DrainLag();

 private:
  BodyFrame TakeOldest();
  void Smooth(Body& body, size_t at) const;

  recon::LagOptions options_;
  std::deque<BodyFrame> held_;
  // Postures by body id, of the held frames and of as many frames before them as the lag is long.
  std::deque<std::map<int, recon::TimedPosture>> window_;
};

}  // namespace ossa::tracker
