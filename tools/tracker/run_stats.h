#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// What `ossa track --json-stats` says, in DESIGN's keys: medians of the stages' milliseconds,
/// median and 99th percentile of the total, frames a second of processing.
class RunStats {
 public:
  void Add(const StageTimes& ms);
  int64_t frames() const { return static_cast<int64_t>(times_.size()); }
  std::string Json(int64_t dropped) const;

 private:
  std::vector<StageTimes> times_;
};

/// Largest resident set of this process so far, megabytes.
double PeakRss_mb();

}  // namespace ossa::tracker
