#pragma once
#include <fmt/format.h>

#include <string>

#include "recon/methods/reconstructor.h"
#include "tools/commands/command.h"

namespace ossa::commands {

/// Throws UsageError for a method that works by what was learned when --learned names nothing.
inline void CheckLearned(const std::string& method, const std::string& learned) {
  if (!recon::NeedsLearned(method) || (!learned.empty() && learned != "none")) return;
  throw UsageError(
      fmt::format("--method {}: expected --learned FILE.ossagp of 'ossa learn' with it, found {}",
                  method, learned.empty() ? "none" : "--learned none"));
}

}  // namespace ossa::commands
