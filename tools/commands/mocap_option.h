#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace ossa::commands {

/// --mocap of a command that learns from motion: what recon::LoadMocap takes.
inline void AddMocapOption(CLI::App& app, std::vector<std::string>& mocap) {
  app.add_option("--mocap", mocap,
                 "BVH or AMC files or folders of them, or the words 'authored' (upright) and "
                 "'authored-floor'; repeat for more")
      ->required();
}

}  // namespace ossa::commands
