#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "recon/methods/reconstructor.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"

namespace ossa::commands {

/// Offline, of `ossa reconstruct` alone: no method of recon::Reconstructor.
inline constexpr const char* kButterworth = "butterworth";

/// What a method reads and keeps; butterworth, and what is no method, read nothing.
inline const recon::MethodInfo& RequireMethodInfo(const std::string& method) {
  static constexpr recon::MethodInfo kReadsNothing{.name = kButterworth};
  const recon::MethodInfo* info = recon::FindMethod(method);
  return info != nullptr ? *info : kReadsNothing;
}

/// Names of the methods for which `holds` does, for messages.
inline std::string MethodsThat(bool (*holds)(const std::string&)) {
  auto methods = recon::ReconstructionMethods();
  methods.emplace_back(kButterworth);
  std::string names;
  for (const std::string& name : methods) {
    if (holds(name)) names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

/// An option that not every method reads.
struct MethodOption {
  const char* name;
  bool (*is_read_by)(const std::string& method);
  bool is_file = false;  // something to use: whoever tries all methods gives it to all of them
};

inline bool IsShum2013(const std::string& method) { return method == "shum-2013"; }
inline bool IsButterworth(const std::string& method) { return method == kButterworth; }
inline bool HasLocalPca(const std::string& method) {
  return method == "shum-2013" || method == "plantard-2016";
}
inline bool ReadsDatabase(const std::string& method) {
  return RequireMethodInfo(method).database != recon::Reads::kNothing;
}
inline bool ReadsLearned(const std::string& method) {
  return RequireMethodInfo(method).learned != recon::Reads::kNothing;
}
inline bool ReadsPrior(const std::string& method) { return RequireMethodInfo(method).prior; }
inline bool KeepsBones(const std::string& method) { return RequireMethodInfo(method).keeps_bones; }

inline constexpr MethodOption kMethodOptions[] = {{"--database", ReadsDatabase, true},
                                                  {"--prior", ReadsPrior, true},
                                                  {"--learned", ReadsLearned, true},
                                                  {"--cutoff", IsButterworth},
                                                  {"--solver", HasLocalPca},
                                                  {"--neighbours", HasLocalPca},
                                                  {"--dimensions", HasLocalPca},
                                                  {"--steps", HasLocalPca},
                                                  {"--samples", HasLocalPca},
                                                  {"--weights", HasLocalPca},
                                                  {"--no-reliability", HasLocalPca},
                                                  {"--keep-reliable", HasLocalPca},
                                                  {"--extend", IsShum2013}};

inline void SayNotRead(const std::string& option, const std::string& method) {
  Say(fmt::format("ossa: {} is not read by --method {}\n", option, method));
}

/// Throws UsageError for an option that was given and that the method does not read: what comes out
/// would be without what was asked for. Of a file it is said unless `quiet`; the word none asks for
/// nothing. Options that a command does not have are not given.
inline void CheckRead(const CLI::App& app, const std::string& method, bool quiet) {
  for (const auto& [name, is_read_by, is_file] : kMethodOptions) {
    const CLI::Option* option = app.get_option_no_throw(name);
    if (option == nullptr || option->count() == 0 || is_read_by(method)) continue;
    if (option->results().front() == "none") continue;
    if (!is_file) {
      throw UsageError(
          fmt::format("{} is not read by --method {}: expected a method that does ({})", name,
                      method, MethodsThat(is_read_by)));
    }
    if (!quiet) SayNotRead(name, method);
  }
}

/// Throws UsageError for a method that works by what was learned when --learned names nothing.
inline void CheckLearned(const std::string& method, const std::string& learned) {
  const bool is_needed = RequireMethodInfo(method).learned == recon::Reads::kRequired;
  if (!is_needed || (!learned.empty() && learned != "none")) return;
  throw UsageError(
      fmt::format("--method {}: expected --learned FILE.ossagp of 'ossa learn' with it, found {}",
                  method, learned.empty() ? "none" : "--learned none"));
}

/// Throws UsageError where a method is given both to complete postures by.
inline void CheckOneOf(const std::string& method, const std::string& database,
                       const std::string& prior) {
  if (!ReadsPrior(method) || database.empty() || prior.empty()) return;
  throw UsageError("--database and --prior: expected one of them, " + method + " completes by one");
}

/// --bones: which frames tell how long a person's bones are.
struct BonesOption {
  std::string from = "so-far";
  bool of_recording() const { return from == "recording"; }
  void AddTo(CLI::App& app) {
    app.add_option("--bones", from,
                   "estimate bone lengths from the frames so far (they may change) or from the "
                   "whole recording (constant lengths)")
        ->capture_default_str()
        ->check(CLI::IsMember({"so-far", "recording"}));
  }
  /// Throws UsageError for a method that moves joints alone.
  void Check(const std::string& method) const {
    if (!of_recording() || KeepsBones(method)) return;
    throw UsageError(
        fmt::format("--bones recording: expected a method that keeps bones ({}), found {}",
                    MethodsThat(KeepsBones), method));
  }
};

}  // namespace ossa::commands
