#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace ossa::commands {

/// A default of a configuration file: what it says and where.
struct DefaultValue {
  std::string command, name;
  std::vector<std::string> values;
  int line = 0;
};

/// The user's file of defaults: $OSSA_CONFIG (empty: none), else $XDG_CONFIG_HOME/ossa/config.toml,
/// else
/// ~/.config/ossa/config.toml. Nothing where there is none; one that OSSA_CONFIG names must be
/// there.
std::optional<std::filesystem::path> DefaultsFile();

/// Reads [COMMAND] tables of name = value, a long option's name without its dashes: texts in
/// quotes, numbers, true, false, and lists of them in one line. Throws InputError that names file
/// and line.
std::vector<DefaultValue> ReadDefaults(const std::filesystem::path& file);

/// Gives the options of `command` that were not on the command line what the user's file says.
/// Throws InputError for names that the command does not have and values that it does not take.
void ApplyDefaults(CLI::App& app, std::string_view command);

}  // namespace ossa::commands
