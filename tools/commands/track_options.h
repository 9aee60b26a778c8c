#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/commands/checks.h"
#include "tools/commands/fit_options.h"
#include "tools/commands/fuse_options.h"
#include "tools/commands/mechanics_options.h"
#include "tools/commands/method_options.h"
#include "tools/commands/outputs.h"
#include "tools/commands/source_options.h"
#include "tools/commands/view_options.h"
#include "tools/stream/sender.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {

/// The parsed arguments of `ossa track`.
struct TrackOptions {
  SourceArguments source;
  std::vector<std::string> more_sources;  // other cameras, for the same people at the same time
  FuseArguments fuse;                     // for these
  std::string out, json_stats, picture, pictures, trace;
  FitArguments fit;
  std::string save_person;
  std::string smoothing, posture = "final", mode = "standing", mount = "auto";
  MechanicsOptions mechanics;
  BonesOption bones;
  WriteOptions write;
  tracker::ModelFiles files;
  tracker::TrackerOptions tracker;
  std::optional<int> lag;  // value of --lag
  int64_t frames = 0;
  std::vector<std::string> send;
  std::vector<stream::Target> targets;  // of `send`
  PageArguments page;                   // of `view`
  bool view = false;
  bool quiet = false;

  /// The names of all sources, the main one first.
  std::vector<std::string> Sources() const {
    std::vector<std::string> names{source.name};
    names.insert(names.end(), more_sources.begin(), more_sources.end());
    return names;
  }
};

/// Throws UsageError for invalid arguments.
TrackOptions ParseTrackOptions(int argc, char** argv);

}  // namespace ossa::commands
