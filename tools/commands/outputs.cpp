#include "tools/commands/outputs.h"

#include <fmt/format.h>

#include <filesystem>
#include <system_error>

#include "depth/error.h"
#include "recon/motion/skeletons/skeleton_io.h"
#include "tools/commands/command.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

// Whether both names are of one file, also where there is none yet.
bool IsOne(const fs::path& a, const fs::path& b) {
  std::error_code unknown;
  if (fs::equivalent(a, b, unknown)) return true;
  return !fs::exists(a, unknown) && !fs::exists(b, unknown) &&
         fs::weakly_canonical(fs::absolute(a, unknown), unknown) ==
             fs::weakly_canonical(fs::absolute(b, unknown), unknown);
}

}  // namespace

void CheckOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty()) continue;
    for (size_t k = 0; k < i; ++k) {
      if (outputs[k].empty() || !IsOne(outputs[i], outputs[k])) continue;
      throw UsageError(outputs[i] + ": expected a file of its own for each output");
    }
    for (const std::string& input : inputs) {
      if (!IsOne(outputs[i], recon::SkeletonFileOf(input))) continue;
      throw UsageError(outputs[i] + ": expected a new file, found what is to be read");
    }
  }
}

void CheckExtension(const char* option, const std::string& path, const char* extension) {
  if (path.empty() || path.ends_with(extension)) return;
  throw UsageError(
      fmt::format("{}: expected a name that ends in {}, found '{}'", option, extension, path));
}

void CheckNotOtherKind(const char* option, const std::string& path, const char* extension) {
  for (const char* other : {".ossa", ".ossadb", ".ossaprior", ".ossagp", ".ossalook", ".oni",
                            ".jsonl", ".json", ".bvh", ".trc", ".csv", ".png", ".html"}) {
    if (path.ends_with(other)) CheckExtension(option, path, extension);
  }
}

void CheckSkeletonName(const std::string& path) {
  try {
    recon::CheckSkeletonExtension(path);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace ossa::commands
