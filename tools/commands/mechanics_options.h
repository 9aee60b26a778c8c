#pragma once
#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "tools/commands/command.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/scene.h"

namespace ossa::commands {

/// The option --physics and those of its character, the same for all commands.
struct MechanicsOptions {
  std::string physics = "off", control = "pd";
  tracker::MechanicsBuild build;
  std::string scene;  // file; all people are simulated in one world
  bool on() const { return physics == "on"; }
  bool follows() const { return on() || !scene.empty(); }
  /// The scene of the file, with characters built as requested here; nothing without a file.
  std::optional<tracker::SceneOptions> Scene() const {
    if (scene.empty()) return std::nullopt;
    tracker::SceneOptions options = tracker::LoadScene(scene);
    options.people = build;
    return options;
  }
  bool stated_off = false;
  /// Throws UsageError if a character is configured without being used, or used and not.
  void Check() const {
    if (stated_off && !scene.empty()) {
      throw Contradiction("--physics off: expected no --scene with it");
    }
    if (follows() || !(build.motors || build.hinges || build.joint_limits)) return;
    const char* option = build.motors   ? "--control motor"
                         : build.hinges ? "--hinges"
                                        : "--joint-limits";
    throw Contradiction(std::string(option) + ": expected --physics on or --scene with it");
  }
};

inline void AddMechanicsOptions(CLI::App& app, MechanicsOptions& options) {
  app.add_option("--physics", options.physics,
                 "let a physical character follow the postures (default off)")
      ->check(CLI::IsMember({"on", "off"}))
      ->each([&options](const std::string& value) { options.stated_off = value == "off"; });
  app.add_option(
      "--scene", options.scene,
      "FILE.toml of boxes, balls and rules: all people in one physics simulation with them");
  app.add_option("--control", options.control,
                 "controller of the character: pd or motor (default pd)")
      ->check(CLI::IsMember({"pd", "motor"}))
      ->each([&options](const std::string& value) { options.build.motors = value == "motor"; });
  app.add_flag("--hinges", options.build.hinges,
               "elbows and knees of the character are hinges (needs --physics on or --scene)");
  app.add_flag(
      "--joint-limits", options.build.joint_limits,
      "joints of the character keep to human ranges of motion (needs --physics on or --scene)");
}

}  // namespace ossa::commands
