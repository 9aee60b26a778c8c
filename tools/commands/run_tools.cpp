#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/base/error.h"
#include "tools/commands/commands.h"

namespace ossa::commands {

int RunTools(int argc, char** argv) {
  const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path() / "ossa-tools";
  std::string own_name = program.string();
  std::vector<char*> arguments = {own_name.data()};
  arguments.insert(arguments.end(), argv, argv + argc);
  arguments.push_back(nullptr);
  execv(program.c_str(), arguments.data());
  if (errno == ENOENT) {
    throw InputError(
        fmt::format("{}: expected the program {}, found none: it is in the Debian "
                    "package ossa-tools (apt install ossa-tools)",
                    argv[0], program.string()));
  }
  throw InputError(fmt::format("{}: {}", program.string(), std::strerror(errno)));
}

}  // namespace ossa::commands
