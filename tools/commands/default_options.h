#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace ossa::commands {

/// A default value of the configuration file, and its place there.
struct DefaultValue {
  std::string command, name;
  std::vector<std::string> values;
  int line = 0;
};

/// The path of the user's file of defaults: $OSSA_CONFIG (empty: none), else
/// $XDG_CONFIG_HOME/ossa/config.toml, else ~/.config/ossa/config.toml. Nothing if it does not
/// exist, unless OSSA_CONFIG names it.
std::optional<std::filesystem::path> DefaultsFile();

/// Reads [COMMAND] tables of name = value, where name is a long option without its dashes, and
/// value is a quoted string, a number, true, false, or a one-line list of these. Throws InputError
/// that names file and line.
std::vector<DefaultValue> ReadDefaults(const std::filesystem::path& file);

/// The defaults of `command` in the user's file.
std::vector<DefaultValue> ListDefaults(std::string_view command);

/// Sets the options of `command` that were not on the command line to the defaults of the user's
/// file, but those named in `left_out`. Throws InputError for names that the command does not have
/// and values that it does not accept.
void ApplyDefaults(CLI::App& app, std::string_view command, const std::set<std::string>& left_out);

}  // namespace ossa::commands
