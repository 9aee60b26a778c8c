#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "tools/tracker/tracker.h"

namespace ossa::tracker {

/// A histogram of durations in bins of 1 %, from a microsecond to some minutes: quantiles to half a
/// per cent in constant memory.
class TimeHistogram {
 public:
  void Add(double ms);
  int64_t count() const { return count_; }
  double sum_ms() const { return sum_ms_; }
  /// The duration that a share (0 to 1) of the values does not exceed, ms; 0 if empty.
  double Quantile(double share) const;

 private:
  std::array<int64_t, 2048> bins_{};
  int64_t count_ = 0;
  double sum_ms_ = 0;
};

/// The report of `ossa track --json-stats` (docs/architecture.md, "Reports"): median milliseconds
/// of the stages, median and 99th percentile of the total, processed frames per second.
class RunStats {
 public:
  void Add(const StageTimes& ms);
  int64_t frames() const { return total_.count(); }
  std::string Json(int64_t dropped) const;

 private:
  TimeHistogram segment_, classify_, propose_, reconstruct_, physics_, total_;
};

/// Largest resident set of this process so far, megabytes.
double PeakRss_mb();

}  // namespace ossa::tracker
