#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "tools/commands/command.h"
#include "tools/tracker/mechanics.h"

namespace ossa::commands {

/// --physics and how its character is built, the same for every command that has one.
struct MechanicsOptions {
  std::string physics = "off", control = "pd";
  tracker::MechanicsBuild build;
  bool on() const { return physics == "on"; }
  /// Throws UsageError for a character that is described and not asked for.
  void Check() const {
    if (on() || !(build.motors || build.hinges || build.joint_limits)) return;
    const char* option = build.motors   ? "--control motor"
                         : build.hinges ? "--hinges"
                                        : "--joint-limits";
    throw UsageError(std::string(option) + ": expected --physics on with it");
  }
};

inline void AddMechanicsOptions(CLI::App& app, MechanicsOptions& options) {
  app.add_option("--physics", options.physics, "let a mechanical character follow (default off)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--control", options.control, "of that character: pd or motor (default pd)")
      ->check(CLI::IsMember({"pd", "motor"}))
      ->each([&options](const std::string& value) { options.build.motors = value == "motor"; });
  app.add_flag("--hinges", options.build.hinges,
               "its elbows and knees bend about one axis (needs --physics on)");
  app.add_flag("--joint-limits", options.build.joint_limits,
               "its joints keep to the ranges that people's have (needs --physics on)");
}

}  // namespace ossa::commands
