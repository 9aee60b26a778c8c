#pragma once
#include <span>
#include <string>
#include <string_view>

namespace ossa::commands {

/// An example command line and its purpose.
struct Example {
  std::string_view line;
  std::string_view purpose;
};

/// The examples of a subcommand; empty for an unknown one.
std::span<const Example> FindExamples(std::string_view command);

/// "Examples:" and one line each, for --help.
std::string ExamplesText(std::string_view command);

}  // namespace ossa::commands
