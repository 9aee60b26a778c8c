#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "depth/base/one_line.h"
#include "tools/commands/closest_word.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"

namespace ossa::commands {
namespace {

std::string HelpText(std::span<const Command> commands) {
  std::string text = "ossa: skeletons from depth images\n\nusage: ossa COMMAND ...\n\n";
  for (const Command& command : commands) {
    text += fmt::format("  {:<12} {}\n", command.name, command.summary);
  }
  return text + "\n'ossa COMMAND --help' shows a command's options and examples.\n";
}

// Former names of commands.
std::string_view CurrentCommandName(std::string_view name) {
  return name == "look" ? "refine" : name;
}

int PrintFailure(const std::string& reason, int status) {
  const char* who = HasColours() ? "\033[1;31mossa:\033[0m " : "ossa: ";  // bold red
  PrintError(who + OnOneLine(reason) + "\n");
  return status;
}

std::string UnknownCommand(std::span<const Command> commands, std::string_view name) {
  std::vector<std::string> names;
  for (const Command& command : commands) names.emplace_back(command.name);
  const std::string meant = ClosestWord(name, names);
  return fmt::format("unknown command '{}'{}", name,
                     meant.empty() ? "" : fmt::format(": is '{}' meant?", meant));
}

// `arguments` as of main, the command's name first.
int RunNamed(std::span<const Command> commands, std::span<char*> arguments) {
  const std::string_view name = arguments.front();
  for (const Command& command : commands) {
    if (command.name == CurrentCommandName(name)) {
      return command.run(static_cast<int>(arguments.size()), arguments.data());
    }
  }
  PrintFailure(UnknownCommand(commands, name), 2);
  PrintError(HelpText(commands));
  return 2;
}

// `ossa help NAME` is `ossa NAME --help`.
int HelpOf(std::span<const Command> commands, char* name) {
  std::string help = "--help";
  std::array<char*, 3> arguments = {name, help.data(), nullptr};
  return RunNamed(commands, std::span(arguments).first(2));
}

// For programs: `ossa NAME --describe` gives the rest.
int ListCommands(std::span<const Command> commands) {
  for (const Command& command : commands) {
    fmt::print("{}\t{}\n", command.name, command.summary);
  }
  return 0;
}

}  // namespace

int RunCommandOf(std::span<const Command> commands, const std::string& version, int argc,
                 char** argv) try {
  const std::string_view name = argc > 1 ? argv[1] : "";
  if (name == "help" && argc > 2) return HelpOf(commands, argv[2]);
  if (name == "--help" || name == "-h" || name == "help") {
    fmt::print("{}", HelpText(commands));
    return 0;
  }
  if (name == "--version") {
    fmt::print("ossa {}\n", version);
    return 0;
  }
  if (name == "--describe") return ListCommands(commands);
  if (argc > 1) return RunNamed(commands, std::span(argv, static_cast<size_t>(argc)).subspan(1));
  PrintError(HelpText(commands));
  return 2;
} catch (const HelpShown&) {
  return 0;
} catch (const UsageError& error) {
  return PrintFailure(error.what(), 2);
} catch (const std::filesystem::filesystem_error& error) {
  return PrintFailure(error.path1().string() + ": " + error.code().message(), 1);
} catch (const std::bad_alloc&) {
  return PrintFailure("out of memory", 1);
} catch (const std::system_error& error) {
  if (std::ferror(stdout) == 0) return PrintFailure(error.what(), 1);
  return EndOutput(0, error.code().value());
} catch (const std::exception& error) {
  return PrintFailure(error.what(), 1);
}

}  // namespace ossa::commands
