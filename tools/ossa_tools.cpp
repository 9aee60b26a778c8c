#include <array>

#include "tools/commands/command.h"
#include "tools/commands/commands.h"
#include "tools/commands/process.h"
#include "tools/tracker/tracker.h"

namespace {

using ossa::commands::Command;

// What `ossa` starts for the commands of the package ossa-tools; there they are summed up.
constexpr std::array kCommands = {
    Command{"render", {}, ossa::commands::Render},
    Command{"train", {}, ossa::commands::Train},
    Command{"evaluate", {}, ossa::commands::Evaluate},
    Command{"refine", {}, ossa::commands::Refine},
    Command{"crop", {}, ossa::commands::Crop},
    Command{"pack-network", {}, ossa::commands::PackNetwork},
    Command{"learn", {}, ossa::commands::Learn},
    Command{"prior", {}, ossa::commands::Prior},
    Command{"surface", {}, ossa::commands::Surface},
    Command{"database", {}, ossa::commands::Database},
    Command{"experiment", {}, ossa::commands::Experiment},
    Command{"study", {}, ossa::commands::Study},
};

}  // namespace

int main(int argc, char** argv) {
  ossa::commands::PrepareProcess();
  const int status = ossa::commands::RunCommandOf(kCommands, ossa::tracker::Version(), argc, argv);
  return ossa::commands::EndOutput(status);
}
