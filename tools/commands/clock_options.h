#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

#include "tools/commands/command.h"
#include "tools/experiments/compare/joint_track.h"

namespace ossa::commands {

/// The options --time and --max-offset of commands that pair recordings with their truth.
struct ClockOptions {
  std::string time = "auto";
  double max_offset_s = tools::PairOptions().max_offset_s;
  bool states_max_offset = false;

  /// `whose` times are shifted: "the results'".
  void AddTo(CLI::App& app, const std::string& whose) {
    app.add_option("--time", time,
                   "auto: cross-correlation where the frame times disagree; none; correlate: "
                   "always; or seconds to add to " +
                       whose + " times")
        ->capture_default_str();
    app.add_option("--max-offset", max_offset_s,
                   "largest offset that correlation considers, seconds")
        ->check(CLI::Range(0.0, 60.0))
        ->capture_default_str()
        ->each([this](const std::string&) { states_max_offset = true; });
  }

  /// Throws UsageError for a time that is neither a word nor a number, and for a largest offset if
  /// none is searched for.
  void Read(tools::PairOptions& options) const {
    options.max_offset_s = max_offset_s;
    if (time == "auto") {
      options.time = tools::TimeAlignment::kAuto;
    } else if (time == "none") {
      options.time = tools::TimeAlignment::kNone;
    } else if (time == "correlate") {
      options.time = tools::TimeAlignment::kCorrelate;
    } else if (CLI::detail::lexical_cast(time, options.offset_s) &&
               std::isfinite(options.offset_s)) {
      options.time = tools::TimeAlignment::kFixed;
    } else {
      throw UsageError("--time: expected auto, none, correlate or seconds, found '" + time + "'");
    }
    const bool searches = options.time == tools::TimeAlignment::kAuto ||
                          options.time == tools::TimeAlignment::kCorrelate;
    if (states_max_offset && !searches) {
      throw Contradiction("--max-offset: expected --time auto or correlate with it, found " + time);
    }
  }
};

}  // namespace ossa::commands
