#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "tools/experiments/compare/metrics.h"
#include "tools/experiments/compare/significance.h"

namespace ossa::tools {

struct CompareOptions {
  PairOptions pairing;
  recon::SkeletonReadOptions reading;
  std::vector<std::string> only;  // clips whose name holds one of these; empty: all
  std::vector<std::string> skip;  // but none whose name holds one of these
  uint64_t seed = 1;              // of the bootstrap; by convention
  std::function<bool()> stop;     // asked before each clip; true: ends by throwing Interruption
  /// Called with the number of compared clips and of all clips over all results; may be empty.
  std::function<void(size_t done, size_t of)> progress;
};

/// One result compared with the truth over all clips that both have.
struct ComparedResult {
  std::string name;                 // as given
  std::string label;                // for tables: the last part of the name where it is unique
  ClipMetrics mean;                 // over the clips
  std::vector<ClipMetrics> clips;   // by name
  std::vector<PairedTracks> pairs;  // of the same clips, for plots
  std::vector<std::string> missing_clips;             // that the truth has and the result does not
  std::optional<Interval> mean_joint_error_interval;  // 95 %, bootstrap over clips
  std::optional<Interval> parent_relative_error_interval;
};

/// A significance test between results over the clips they share, as in Plantard 2016, 8.2.
struct ComparedTest {
  std::string test;      // e.g. "Wilcoxon signed rank"
  std::string quantity;  // e.g. "share of frames over 20 cm"
  std::string between;   // names of the results
  size_t units = 0;      // clips
  TestResult result;
  double corrected_p = 1;  // after Bonferroni
};

struct Comparison {
  std::string truth;
  bool rigid = false;
  bool found_only = false;
  std::vector<ComparedResult> results;
  std::vector<ComparedTest> tests;
  std::vector<std::string> warnings;  // of reading, for people to see
};

/// Reads and compares. Clips are matched by name; a single clip on both sides needs no equal name.
/// From files that contain truth and estimate, each side takes its own by default. Throws
/// Interruption (tools/experiments/experiment.h) if `stop` returns true.
Comparison Compare(const std::string& truth, const std::vector<std::string>& results,
                   const CompareOptions& options);

/// The object of `ossa compare --json` (docs/architecture.md), plus confidence intervals, clips and
/// tests.
std::string ToJson(const Comparison& comparison);
/// A suggestion if the errors show that the skeletons are in different coordinate systems or on
/// different clocks, that one is mirrored, or that one is steadily late or early; else "".
std::string MakeAdvice(const Comparison& comparison);
/// The clocks of a result and its truth that evidently differ.
struct ClockDifference {
  double offset_s = 0.0;  // to add to the times of the result
  // Parent-relative errors (ClipMetrics) as the times are, and with the offset.
  double error_cm = 0.0, moved_cm = 0.0;
};
/// Of pairs whose clock was not looked for: the difference of the first that is far nearer to the
/// truth at an offset of at most 2 s. None where the clocks are one, or nothing shows it.
std::optional<ClockDifference> FindClockDifference(const std::vector<PairedTracks>& pairs);
/// Of a message: offset and errors.
std::string Describe(const ClockDifference& clock);
/// Tables for a terminal.
std::string ToText(const Comparison& comparison);
/// A self-contained HTML file: tables, error over time, cumulative curves, bars per joint, the
/// worst frames.
std::string ToHtml(const Comparison& comparison);

}  // namespace ossa::tools
