#include "tools/experiments/compare/median_offset.h"

#include <algorithm>
#include <cmath>

#include "depth/base/statistics.h"
#include "tools/experiments/compare/clock_offset.h"

namespace ossa::tools {
namespace {

// Constants: by hand. On UI-PRMD's 1341 pairs, which are aligned to 10 ms each, one piece of a
// second or more is off by 7 ms in the median and by more than a frame in one of ten.

constexpr double kPiece_s = 3.0;
constexpr double kFarthest_s = 0.3;                     // farther, FindClockDifference() finds it
constexpr size_t kFewestPieces = 8, kMostPieces = 100;  // no unit; the most: for speed

/// The frames from `start_s` until before `end_s`.
JointTrack CutOut(const std::vector<double>& time_s, const std::vector<SparsePosture>& postures,
                  double start_s, double end_s) {
  const auto first = std::lower_bound(time_s.begin(), time_s.end(), start_s);
  const auto last = std::lower_bound(first, time_s.end(), end_s);
  return {
      {first, last},
      {postures.begin() + (first - time_s.begin()), postures.begin() + (last - time_s.begin())}};
}

}  // namespace

void OffsetOfPieces::Add(const PairedTracks& pair, const std::function<bool()>& stop) {
  if (pair.time_s.empty()) return;
  for (size_t f = 1; f < pair.time_s.size(); ++f) {
    steps_s_.push_back(pair.time_s[f] - pair.time_s[f - 1]);
  }
  const double length_s = pair.time_s.back() - pair.time_s.front();
  const auto pieces = static_cast<size_t>(std::max(1.0, std::round(length_s / kPiece_s)));
  for (size_t p = 0; p < pieces && offsets_s_.size() < kMostPieces; ++p) {
    const double start_s = pair.time_s.front() + static_cast<double>(p) * kPiece_s;
    const double end_s = start_s + kPiece_s;
    const JointTrack truth =
        CutOut(pair.time_s, pair.truth, start_s - kFarthest_s, end_s + kFarthest_s);
    const ClockMatch match =
        MatchClocks(truth, CutOut(pair.time_s, pair.result, start_s, end_s), kFarthest_s, stop);
    if (match.significance > 0) offsets_s_.push_back(match.offset_s);
  }
}

std::optional<MedianOffset> OffsetOfPieces::FindEvident() const {
  constexpr double kLeastFrames = 0.5;  // of the offset: a smaller one is another exposure
  constexpr double kEvident = 4.0;      // standard errors
  if (offsets_s_.size() < kFewestPieces) return std::nullopt;
  MedianOffset found;
  found.pieces = offsets_s_.size();
  found.offset_s = Median(offsets_s_);
  found.frame_s = Median(steps_s_);
  std::vector<double> apart_s;
  for (const double offset_s : offsets_s_) apart_s.push_back(std::abs(offset_s - found.offset_s));
  // Of a normal distribution: 1.4826 median absolute deviations are a standard deviation, and the
  // median's standard error is sqrt(pi / 2) times the mean's.
  constexpr double kPerDeviation = 1.4826 * 1.2533;  // no unit
  found.standard_error_s =
      kPerDeviation * Median(std::move(apart_s)) / std::sqrt(static_cast<double>(found.pieces));
  const double offset_s = std::abs(found.offset_s);
  if (offset_s < kLeastFrames * found.frame_s || offset_s < kEvident * found.standard_error_s) {
    return std::nullopt;
  }
  return found;
}

}  // namespace ossa::tools
