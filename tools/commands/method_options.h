#pragma once
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "recon/methods/reconstructor.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"

namespace ossa::commands {

/// An offline filter of `ossa reconstruct`, not a recon::Reconstructor.
inline constexpr const char* kButterworth = "butterworth";

/// The properties of a method; butterworth and unknown names read nothing.
inline const recon::MethodInfo& RequireMethodInfo(const std::string& method) {
  static constexpr recon::MethodInfo kReadsNothing{.name = kButterworth};
  const recon::MethodInfo* info = recon::FindMethod(method);
  return info != nullptr ? *info : kReadsNothing;
}

/// The names of the methods for which `holds` is true, for messages.
inline std::string MethodsThat(bool (*holds)(const std::string&)) {
  auto methods = recon::ReconstructionMethods();
  methods.emplace_back(kButterworth);
  std::string names;
  for (const std::string& name : methods) {
    if (holds(name)) names += (names.empty() ? "" : ", ") + name;
  }
  return names;
}

/// An option that only some methods read.
struct MethodOption {
  const char* name;
  bool (*is_read_by)(const std::string& method);
  bool is_file = false;  // a model file, which may be given to all methods when several are tried
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

inline void PrintNotRead(const std::string& option, const std::string& method) {
  PrintError(fmt::format("ossa: {} is not read by --method {}\n", option, method));
}

/// The given options that the method does not read, except with the value "none". Options that the
/// command does not have count as not given.
inline std::vector<MethodOption> ListNotRead(const CLI::App& app, const std::string& method) {
  std::vector<MethodOption> not_read;
  for (const MethodOption& one : kMethodOptions) {
    const CLI::Option* option = app.get_option_no_throw(one.name);
    if (option == nullptr || option->count() == 0 || one.is_read_by(method)) continue;
    if (option->results().front() != "none") not_read.push_back(one);
  }
  return not_read;
}

/// Throws Contradiction for a given option that the method does not read, because the result would
/// not be as requested; not for a file.
inline void CheckRead(const CLI::App& app, const std::string& method) {
  for (const auto& [name, is_read_by, is_file] : ListNotRead(app, method)) {
    if (is_file) continue;
    throw Contradiction(
        fmt::format("{} is not read by --method {}: expected a method that does ({})", name, method,
                    MethodsThat(is_read_by)));
  }
}

inline void PrintFilesNotRead(const CLI::App& app, const std::string& method) {
  for (const MethodOption& option : ListNotRead(app, method)) {
    if (option.is_file) PrintNotRead(option.name, method);
  }
}

/// Throws Contradiction for a method that needs a learned model, if --learned is missing.
inline void CheckLearned(const std::string& method, const std::string& learned) {
  const bool is_needed = RequireMethodInfo(method).learned == recon::Reads::kRequired;
  if (!is_needed || (!learned.empty() && learned != "none")) return;
  throw Contradiction(
      fmt::format("--method {}: expected --learned FILE.ossagp of 'ossa learn' with it, found {}",
                  method, learned.empty() ? "none" : "--learned none"));
}

/// Throws Contradiction if both sources for completing postures are given.
inline void CheckOneOf(const std::string& method, const std::string& database,
                       const std::string& prior) {
  if (!ReadsPrior(method) || database.empty() || prior.empty()) return;
  throw Contradiction("--database and --prior: expected one of them, " + method +
                      " completes by one");
}

/// The option --bones: which frames determine a person's bone lengths.
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
  /// Throws Contradiction for a method that does not keep bone lengths.
  void Check(const std::string& method) const {
    if (!of_recording() || KeepsBones(method)) return;
    throw Contradiction(
        fmt::format("--bones recording: expected a method that keeps bones ({}), found {}",
                    MethodsThat(KeepsBones), method));
  }
};

}  // namespace ossa::commands
