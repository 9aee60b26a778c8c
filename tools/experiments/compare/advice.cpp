// Detects errors of the comparison itself: other spaces or clocks, mirrored images.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "tools/experiments/compare/clock_offset.h"
#include "tools/experiments/compare/comparison.h"
#include "tools/experiments/compare/median_offset.h"

namespace ossa::tools {
namespace {

// Constants: by hand unless stated otherwise.

// For ordinary tracking, mirroring or shifting in time does not reduce the error; for a symmetric
// posture the errors are equal.
constexpr double kFarNearer = 0.5;  // ratio, no unit
constexpr double kLeast_cm = 4.0;

bool IsFarNearer(const std::optional<double>& other_cm, const std::optional<double>& error_cm) {
  return other_cm && error_cm && *error_cm >= kLeast_cm && *other_cm <= kFarNearer * *error_cm;
}

// With the error that is left if it is followed.
struct Advice {
  std::string text;
  double error_cm = 0.0;
};

// For each clip: a folder may contain mirrored clips and others.
std::optional<Advice> AdviseOnMirroring(const ComparedResult& result) {
  for (const PairedTracks& pair : result.pairs) {
    const auto error_cm = Measure(pair).parent_relative_error_cm;
    const auto mirrored_cm = MirroredRelativeError_cm(pair);
    if (!IsFarNearer(mirrored_cm, error_cm)) continue;
    return Advice{fmt::format("{} is far nearer to the truth as a mirror shows it (parent-relative "
                              "error {:.1f} instead of {:.1f} cm): if its depth images were "
                              "mirrored, track them with --mirrored.",
                              result.label, *mirrored_cm, *error_cm),
                  *mirrored_cm};
  }
  return std::nullopt;
}

// The beginning of a pair, long enough to compare clocks and short enough to search quickly.
PairedTracks SelectBeginning(const PairedTracks& pair) {
  constexpr double kEnough_s = 60.0;
  PairedTracks beginning;
  for (size_t f = 0; f < pair.time_s.size(); ++f) {
    if (pair.time_s[f] > pair.time_s.front() + kEnough_s) break;
    beginning.time_s.push_back(pair.time_s[f]);
    beginning.truth.push_back(pair.truth[f]);
    beginning.result.push_back(pair.result[f]);
  }
  return beginning;
}

// The same with `offset_s` added to the result's times.
PairedTracks AtOffset(const PairedTracks& pair, double offset_s) {
  const JointTrack truth{pair.time_s, pair.truth};
  PairedTracks moved;
  for (size_t f = 0; f < pair.time_s.size(); ++f) {
    const double time_s = pair.time_s[f] + offset_s;
    const auto posture = PostureAt(truth, time_s);
    if (!posture) continue;
    moved.time_s.push_back(time_s);
    moved.truth.push_back(*posture);
    moved.result.push_back(pair.result[f]);
  }
  return moved;
}

std::optional<Advice> AdviseOnClock(const ComparedResult& result) {
  const auto found = FindClockDifference(result.pairs);
  if (!found) return std::nullopt;
  return Advice{fmt::format("{} is far nearer to the truth {}: if their clocks differ, add --time "
                            "correlate.",
                            result.label, Describe(*found)),
                found->moved_cm};
}

// A lag of a filter or a sensor is an error, that of another clock is none: both look alike.
std::string AdviseOnLag(const Comparison& comparison) {
  for (const ComparedResult& result : comparison.results) {
    OffsetOfPieces pieces;
    for (const PairedTracks& pair : result.pairs) {
      if (pair.same_clock) pieces.Add(pair);
    }
    const auto found = pieces.FindEvident();
    if (!found) continue;
    return fmt::format(
        "{} is {:.3f} s {} the truth, {:.1f} frames (standard error {:.3f} s, median of {} pieces "
        "of 3 s): that counts as error; if only the clocks differ, add --time {:.3f}.",
        result.label, std::abs(found->offset_s), found->offset_s < 0 ? "behind" : "ahead of",
        std::abs(found->offset_s) / found->frame_s, found->standard_error_s, found->pieces,
        found->offset_s);
  }
  return "";
}

std::string AdviseOnOrigin(const ComparedResult& result) {
  constexpr double kApart_cm = 50.0;  // no sensor has such a mean error
  const auto error_cm = result.mean.mean_joint_error_cm;
  if (!error_cm || *error_cm < kApart_cm) return "";
  return fmt::format(
      "{} lies {:.1f} m away from the truth: if their origins or axes differ, add --align rigid.",
      result.label, *error_cm / 100.0);
}

}  // namespace

// Files that begin at 0 with the same rate have equal frame times, whenever they were started.
std::optional<ClockDifference> FindClockDifference(const std::vector<PairedTracks>& pairs) {
  constexpr double kFarthest_s = 2.0;   // as PairOptions::max_offset_s
  constexpr double kShortest_s = 0.15;  // a smaller offset may be a filter's lag, which is an error
  int searches = 5;                     // for speed: only the first clips with large errors
  for (const PairedTracks& whole : pairs) {
    if (!whole.same_clock || searches == 0) continue;
    const PairedTracks pair = SelectBeginning(whole);
    const auto error_cm = Measure(pair).parent_relative_error_cm;
    if (error_cm.value_or(0) < kLeast_cm) continue;
    --searches;
    const double offset_s =
        MatchClocks({pair.time_s, pair.truth}, {pair.time_s, pair.result}, kFarthest_s).offset_s;
    if (std::abs(offset_s) < kShortest_s) continue;
    const auto moved_cm = Measure(AtOffset(pair, offset_s)).parent_relative_error_cm;
    if (IsFarNearer(moved_cm, error_cm)) return ClockDifference{offset_s, *error_cm, *moved_cm};
  }
  return std::nullopt;
}

std::string Describe(const ClockDifference& clock) {
  return fmt::format(
      "with {:+.2f} s added to its times (parent-relative error {:.1f} instead of {:.1f} cm)",
      clock.offset_s, clock.moved_cm, clock.error_cm);
}

std::string MakeAdvice(const Comparison& comparison) {
  for (const ComparedResult& result : comparison.results) {
    const bool same_space = !comparison.rigid;
    const auto mirrored = same_space ? AdviseOnMirroring(result) : std::nullopt;
    const auto clock = AdviseOnClock(result);
    // A symmetrical movement half its period off is nearer as a mirror shows it, too.
    if (mirrored && !(clock && clock->error_cm < mirrored->error_cm)) return mirrored->text;
    if (clock) return clock->text;
    if (std::string origin = same_space ? AdviseOnOrigin(result) : ""; !origin.empty()) {
      return origin;
    }
  }
  return AdviseOnLag(comparison);
}

}  // namespace ossa::tools
