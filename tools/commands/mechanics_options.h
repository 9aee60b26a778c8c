#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/tracker/mechanics.h"

namespace ossa::commands {

/// --physics and how its character is built, the same for every command that has one.
struct MechanicsOptions {
  std::string physics = "off", control = "pd";
  tracker::MechanicsBuild build;
  bool on() const { return physics == "on"; }
};

inline void AddMechanicsOptions(CLI::App& app, MechanicsOptions& options) {
  auto* physics = app.add_option("--physics", options.physics,
                                 "let a mechanical character follow (default off)")
                      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--control", options.control, "of that character: pd or motor (default pd)")
      ->check(CLI::IsMember({"pd", "motor"}))
      ->each([&options](const std::string& value) { options.build.motors = value == "motor"; });
  app.add_flag("--hinges", options.build.hinges,
               "its elbows and knees bend about one axis (needs --physics)")
      ->needs(physics);
  app.add_flag("--joint-limits", options.build.joint_limits,
               "its joints keep to the ranges that people's have (needs --physics)")
      ->needs(physics);
}

}  // namespace ossa::commands
