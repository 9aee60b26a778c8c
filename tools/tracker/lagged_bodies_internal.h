#pragma once
#include <deque>
#include <map>
#include <optional>

#include "recon/filters/lag_smoothing.h"
#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// Bodies some frames later, their joints smoothed by what came before and after. Every frame that
/// goes in comes out once, in order, whoever is in it, under its own index and time.
class LaggedBodies {
 public:
  explicit LaggedBodies(const recon::LagOptions& options) : options_(options) {}
  /// One more frame; the oldest one held, once so many came after it.
  std::optional<BodyFrame> Add(BodyFrame frame);
  /// At the end of a stream: the oldest frame held, smoothed by what there is; none when all are
  /// out. Frames that are added afterwards belong to another stream.
  std::optional<BodyFrame> DrainLag();

 private:
  BodyFrame TakeOldest();
  void Smooth(Body& body, size_t at) const;

  recon::LagOptions options_;
  std::deque<BodyFrame> held_;
  // By body id, of the held frames and of as many before them as the lag is long.
  std::deque<std::map<int, recon::TimedPosture>> window_;
};

}  // namespace ossa::tracker
