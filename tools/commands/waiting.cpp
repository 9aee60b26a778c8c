#include "tools/commands/waiting.h"

#include <fmt/format.h>

#include <cstdio>

#include "tools/commands/command.h"

namespace ossa::commands {

std::function<bool()> KeepWaitingFor(const std::string& source, bool quiet) {
  return [source, said = quiet]() mutable {
    if (!said) fmt::print(stderr, "waiting for {} (Ctrl-C ends it)\n", source);
    said = true;
    return !Interrupted();
  };
}

}  // namespace ossa::commands
