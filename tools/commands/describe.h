#pragma once
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace ossa::commands {

/// The interface of a subcommand as one line of JSON: {"command", "description", "positionals":
/// [{"name", "required", "repeats", "help"}], "options": [{"names", "value" ("" of a flag),
/// "choices", "range" ("[1 - 6]", or ""), "default" ("" where the help says it), "required",
/// "repeats", "help"}], "notes", "examples": [{"line", "purpose"}]}. Manual pages and shell
/// completion are generated from it (`ossa COMMAND --describe`).
std::string Describe(const CLI::App& app, std::string_view command);

}  // namespace ossa::commands
