#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <set>
#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/commands/default_options.h"
#include "tools/commands/process.h"

namespace ossa::commands {

/// Which of the user's defaults go together with the command line, and why the others do not.
struct FittingDefaults {
  std::set<std::string> left_out;  // names of options
  std::string reasons;             // a line for each
};

/// Adds the defaults of `command` one by one in the order of the file, again until no other fits.
/// `parse` takes the names of those to leave out and throws Contradiction. Throws UsageError for a
/// contradiction within the command line.
template <typename ParseFunction>
FittingDefaults FindFittingDefaults(const std::string& command, const ParseFunction& parse) {
  const std::vector<DefaultValue> defaults = ListDefaults(command);
  FittingDefaults fitting;
  for (const DefaultValue& value : defaults) fitting.left_out.insert(value.name);
  parse(fitting.left_out);
  for (bool added = true; added;) {
    added = false;
    fitting.reasons.clear();
    for (const DefaultValue& value : defaults) {
      if (fitting.left_out.erase(value.name) == 0) continue;
      try {
        parse(fitting.left_out);
        added = true;
      } catch (const Contradiction& contradiction) {
        fitting.left_out.insert(value.name);
        fitting.reasons +=
            fmt::format("ossa: {}: line {}: {} is not used: {}\n", DefaultsFile()->string(),
                        value.line, value.name, contradiction.what());
      }
    }
  }
  return fitting;
}

/// Functions of a command whose options depend on each other. All but the last may be called
/// several times.
template <typename Options>
struct ConsistentOptions {
  const char* title;
  void (*declare)(CLI::App& app, Options& options);
  void (*check)(const CLI::App& app, Options& options);  // throws Contradiction
  /// Prints what is given and not read; may be null.
  void (*note)(const CLI::App& app, const Options& options) = nullptr;
};

/// Parses the arguments of such a command. The command line takes precedence: a default of the
/// user's file that contradicts it, or a default before, is left out, with a line on stderr unless
/// the options are quiet.
template <typename Options>
Options ParseConsistently(const ConsistentOptions<Options>& of, int argc, char** argv) {
  const auto parse = [&](const std::set<std::string>& left_out, bool is_last) {
    CLI::App app(of.title);
    Options options;
    of.declare(app, options);
    Parse(app, argc, argv, left_out);
    of.check(app, options);
    if (is_last && of.note) of.note(app, options);
    return options;
  };
  try {
    return parse({}, true);
  } catch (const Contradiction&) {
    if (ListDefaults(argv[0]).empty()) throw;
  }
  const FittingDefaults fitting = FindFittingDefaults(
      argv[0], [&](const std::set<std::string>& left_out) { parse(left_out, false); });
  Options options = parse(fitting.left_out, true);
  bool quiet = false;
  if constexpr (requires { options.quiet; }) quiet = options.quiet;
  if (!quiet) PrintError(fitting.reasons);
  return options;
}

}  // namespace ossa::commands
