#pragma once
#include <span>
#include <string>
#include <string_view>

namespace ossa::commands {

/// A command line as people type it, and what it is for.
struct Example {
  std::string_view line;
  std::string_view purpose;
};

/// Of a subcommand; empty for what is none.
std::span<const Example> FindExamples(std::string_view command);

/// "Examples:" and a line each, as --help shows them.
std::string ExamplesText(std::string_view command);

}  // namespace ossa::commands
