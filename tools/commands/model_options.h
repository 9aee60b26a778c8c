#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/tracker/model_set.h"
#include "tools/tracker/tracker.h"

namespace ossa::commands {

/// Adds the model options of commands that track, except the body of the surface fit.
inline void AddModelOptions(CLI::App& app, tracker::ModelFiles& files) {
  app.add_option("--model", files.forest, "forest model, .ossa (default: the shipped one)");
  app.add_option(
      "--database", files.database,
      "posture database, .ossadb (default: the shipped one; best uses the shipped prior instead)");
  app.add_option("--prior", files.prior,
                 ".ossaprior of 'ossa prior', for best (default: the shipped one)");
  app.add_option("--learned", files.learned,
                 ".ossagp of 'ossa learn', for the methods that learn, or none (default: the "
                 "shipped one, with best and the shipped model)");
  app.add_option("--refinement,--look", files.refinement,
                 ".ossarefine of 'ossa refine', for best and --posture refined, or none (default: "
                 "the shipped one, with best and the shipped model); one that was trained on "
                 "people seen from the ceiling is used for cameras there only");
  app.add_option(
      "--pose-network", files.pose_network,
      ".ossanet of tools/train_pose_network, shipped, or none: a network that "
      "estimates all joints from the image of the whole person, fused with the refined "
      "joints, except under the ceiling (default: shipped, with the shipped refinement)");
}

/// Adds --mount: how the camera is mounted.
inline void AddMountOption(CLI::App& app, std::string& mount) {
  app.add_option(
         "--mount", mount,
         "mounting of the camera: level, ceiling (2.2 to 4 m up, looking down) or auto (default)")
      ->check(CLI::IsMember({"auto", "level", "ceiling"}));
}

inline tracker::Mount ParseMount(const std::string& mount) {
  if (mount == "level") return tracker::Mount::kLevel;
  return mount == "ceiling" ? tracker::Mount::kCeiling : tracker::Mount::kAuto;
}

}  // namespace ossa::commands
