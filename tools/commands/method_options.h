#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
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

/// Throws UsageError where best is given both to complete postures by.
inline void CheckOneOf(const std::string& method, const std::string& database,
                       const std::string& prior) {
  if (method != "best" || database.empty() || prior.empty()) return;
  throw UsageError("--database and --prior: expected one of them, best completes by one");
}

/// --bones: which frames tell how long a person's bones are.
struct BonesOption {
  std::string from = "so-far";
  bool of_recording() const { return from == "recording"; }
  void AddTo(CLI::App& app) {
    app.add_option("--bones", from,
                   "how long a person's bones are by: so-far, the frames until then (they may "
                   "change), or recording, all frames (the same lengths in each of them)")
        ->capture_default_str()
        ->check(CLI::IsMember({"so-far", "recording"}));
  }
  /// Throws UsageError for a method that moves joints alone.
  void Check(const std::string& method) const {
    if (!of_recording() || recon::KeepsBones(method)) return;
    std::string keeping;
    for (const std::string& name : recon::ReconstructionMethods()) {
      if (recon::KeepsBones(name)) keeping += (keeping.empty() ? "" : ", ") + name;
    }
    throw UsageError(fmt::format(
        "--bones recording: expected a method that keeps bones ({}), found {}", keeping, method));
  }
};

}  // namespace ossa::commands
