#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "recon/skeleton_sequence.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"
#include "tools/tracker/dynamics.h"

namespace ossa::commands {

/// The option --floor auto|a,b,c,d, for recordings without a floor.
class FloorOption {
 public:
  void AddTo(CLI::App& app) {
    app.add_option("--floor", text_,
                   "floor of recordings that have none: auto, estimated from people who stand "
                   "straight, or a,b,c,d of ax + by + cz + d = 0, metres, a b c upwards");
  }
  /// Throws UsageError for other values.
  void Check() {
    if (text_.empty() || text_ == "auto") return;
    Eigen::Vector4d p = Eigen::Vector4d::Zero();
    char rest = 0;
    const int found =
        std::sscanf(text_.c_str(), "%lf,%lf,%lf,%lf%c", &p[0], &p[1], &p[2], &p[3], &rest);
    if (found != 4 || !p.allFinite() || !(p.head<3>().norm() > 1e-6)) {
      throw UsageError(fmt::format("--floor: expected auto or a,b,c,d, found {}", text_));
    }
    plane_ = p / p.head<3>().norm();
  }
  /// Sets the floor of frames without one; prints a line if it cannot be estimated.
  void Apply(recon::SkeletonSequence& sequence, bool quiet) const {
    if (text_.empty()) return;
    const auto floor = plane_ ? plane_ : tracker::EstimateFloor(sequence);
    if (!floor && !quiet) {
      PrintError(fmt::format("reconstruct: {}: nobody stands straight for long: no floor\n",
                             sequence.source));
    }
    if (!floor) return;
    for (recon::SkeletonFrame& frame : sequence.frames) {
      if (!frame.floor) frame.floor = floor;
    }
  }

 private:
  std::string text_;
  std::optional<Eigen::Vector4d> plane_;
};

}  // namespace ossa::commands
