#pragma once
#include <functional>
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "recon/models/pairs.h"
#include "tools/experiments/compare/joint_track.h"

namespace ossa::tools {

struct PairRecordingsOptions {
  recon::SkeletonReadOptions reading;
  /// Whether the clock of each observed recording is aligned with the truth's; else times are taken
  /// as they are, with a warning where the clocks evidently differ.
  PairOptions clock{.time = TimeAlignment::kNone};
  /// Called with the recordings of each file, for their warnings; returns false to stop: the pairs
  /// until then are returned. May be empty.
  std::function<bool(const std::vector<recon::SkeletonClip>&)> read{};
  /// Called with a line about each offset that was found; may be empty.
  std::function<void(const std::string&)> note{};
};

/// Pairs of observed and true skeletons from files, folders or archives: the first of `observed`
/// belongs to the first of `truth`, and so on. Recordings in them are paired by name, single ones
/// on both sides whatever their names; others are left out, with a warning. Recordings of one
/// `observed` whose names begin with the same folder (or archive) are of one person. Throws
/// InputError that names the files between which no frame matches, and Interruption
/// (tools/experiments/experiment.h) if `clock.stop` returns true.
std::vector<recon::PosturePair> PairRecordings(const std::vector<std::string>& observed,
                                               const std::vector<std::string>& truth,
                                               const PairRecordingsOptions& options = {});

}  // namespace ossa::tools
