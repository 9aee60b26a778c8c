#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "depth/one_line.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/process.h"
#include "tools/commands/study.h"

namespace {

using ossa::commands::Command;

constexpr std::array kCommands = {
    Command{"evaluate", "measure a model on labelled data", ossa::commands::Evaluate},
    Command{"compare", "judge skeletons against the truth", ossa::commands::Compare},
    Command{"experiment", "run a study: a paper's tables beside its own numbers",
            ossa::commands::Experiment},
    Command{"study", "run an experiment as a TOML file describes it", ossa::commands::Study},
    Command{"database", "build a posture database from motion capture", ossa::commands::Database},
    Command{"learn", "learn a sensor's errors from observed and true skeletons",
            ossa::commands::Learn},
    Command{"prior", "learn from motion capture how people move", ossa::commands::Prior},
    Command{"reconstruct", "make recorded skeletons complete and plausible",
            ossa::commands::Reconstruct},
    Command{"info", "say what a file of ossa's holds", ossa::commands::Info},
    Command{"record", "record a source to an .oni file", ossa::commands::Record},
    Command{"track", "follow people and write their skeletons", ossa::commands::Track},
    Command{"view", "show a source or a skeleton file in a browser", ossa::commands::View},
    Command{"train", "train a body-part forest on labelled data", ossa::commands::Train},
    Command{"render", "make labelled depth images of people in motion", ossa::commands::Render},
};

std::string HelpText() {
  std::string text = "ossa: skeletons from depth images\n\nusage: ossa COMMAND ...\n\n";
  for (const Command& command : kCommands) {
    text += fmt::format("  {:<12} {}\n", command.name, command.summary);
  }
  return text + "\n'ossa COMMAND --help' says everything about one.\n";
}

int Complain(const std::string& reason, int status) {
  ossa::commands::Say("ossa: " + ossa::OnOneLine(reason) + "\n");
  return status;
}

int Run(int argc, char** argv) try {
  const std::string_view name = argc > 1 ? argv[1] : "";
  if (name == "--help" || name == "-h") {
    fmt::print("{}", HelpText());
    return 0;
  }
  if (name == "--version") {
    fmt::print("ossa {}\n", OSSA_VERSION);
    return 0;
  }
  for (const Command& command : kCommands) {
    if (command.name == name) return command.run(argc - 1, argv + 1);
  }
  if (!name.empty()) Complain(fmt::format("unknown command '{}'", name), 2);
  ossa::commands::Say(HelpText());
  return 2;
} catch (const ossa::commands::HelpShown&) {
  return 0;
} catch (const ossa::commands::UsageError& error) {
  return Complain(error.what(), 2);
} catch (const std::filesystem::filesystem_error& error) {
  return Complain(error.path1().string() + ": " + error.code().message(), 1);
} catch (const std::bad_alloc&) {
  return Complain("out of memory", 1);
} catch (const std::system_error& error) {
  if (std::ferror(stdout) == 0) return Complain(error.what(), 1);
  return ossa::commands::EndOutput(0, error.code().value());
} catch (const std::exception& error) {
  return Complain(error.what(), 1);
}

}  // namespace

int main(int argc, char** argv) {
  ossa::commands::PrepareProcess();
  return ossa::commands::EndOutput(Run(argc, argv));
}
