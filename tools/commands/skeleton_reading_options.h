#pragma once
#include <CLI/CLI.hpp>

#include "recon/files/skeleton_io.h"
#include "tools/commands/mapping_option.h"

namespace ossa::commands {

/// --mapping and --fps of a command that reads skeletons: what their files may leave unsaid. The
/// caller's footer has MappingHelp().
inline void AddSkeletonReadingOptions(CLI::App& app, recon::SkeletonReadOptions& reading) {
  AddMappingOption(app, reading.mapping_file, false);
  app.add_option_function<double>(
         "--fps", [&reading](double rate_hz) { reading.frame_s = 1.0 / rate_hz; },
         "frame rate of skeletons whose file states no times, Hz (default: the usual one of its "
         "format, 30 for tables and SDK files)")
      ->check(CLI::Range(0.001, 10000.0));  // as of depth images
}

}  // namespace ossa::commands
