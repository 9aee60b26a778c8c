#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace ossa::commands {

/// --physics and --control, the same for every command that has a mechanical character.
struct MechanicsOptions {
  std::string physics = "off", control = "pd";
  bool on() const { return physics == "on"; }
  bool motors() const { return control == "motor"; }
};

inline void AddMechanicsOptions(CLI::App& app, MechanicsOptions& options) {
  app.add_option("--physics", options.physics, "let a mechanical character follow (default off)")
      ->check(CLI::IsMember({"on", "off"}));
  app.add_option("--control", options.control, "of that character: pd or motor (default pd)")
      ->check(CLI::IsMember({"pd", "motor"}));
}

}  // namespace ossa::commands
