#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "recon/motion/mocap.h"

namespace ossa::commands {

/// Adds --amc-fps for a command that reads motion.
inline void AddAmcRateOption(CLI::App& app, recon::MocapOptions& options) {
  app.add_option("--amc-fps", options.amc_hz,
                 "frame rate of AMC files, which do not state it, Hz (default 120, as CMU and "
                 "HDM05 publish)")
      ->check(CLI::Range(1.0, 1e4));
}

/// Adds --mocap and --amc-fps for a command that learns from motion: the input of recon::LoadMocap.
inline void AddMocapOption(CLI::App& app, std::vector<std::string>& mocap,
                           recon::MocapOptions& options) {
  app.add_option("--mocap", mocap,
                 "BVH or AMC files or folders of them, or the words 'authored' (upright) and "
                 "'authored-floor'; repeat for more")
      ->required();
  AddAmcRateOption(app, options);
}

}  // namespace ossa::commands
