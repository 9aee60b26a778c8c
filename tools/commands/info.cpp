#include <CLI/CLI.hpp>
#include <array>
#include <fstream>
#include <string>

#include "depth/error.h"
#include "tools/commands/command.h"
#include "tools/commands/commands.h"

namespace ossa::commands {

int Info(int argc, char** argv) {
  CLI::App app(
      "Say what a file of ossa's holds: a model's card, a database's size, a data set's origin");
  std::string file;
  app.add_option("FILE", file, "a .ossa, .ossadb, .ossagp or .oni file, or a DATASET folder")
      ->required();
  Parse(app, argc, argv);
  throw InputError(file + ": not a file that ossa knows");
}

}  // namespace ossa::commands
