#include "tools/commands/outputs.h"

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <map>
#include <system_error>

#include "depth/base/error.h"
#include "depth/base/lower_case.h"
#include "recon/files/skeleton_io.h"
#include "tools/commands/command.h"
#include "tools/commands/process.h"
#include "tools/tracker/body_mesh_file.h"

namespace ossa::commands {
namespace {

namespace fs = std::filesystem;

// Whether both names refer to one file, which need not exist.
bool IsSameFile(const fs::path& a, const fs::path& b) {
  std::error_code unknown;
  if (fs::equivalent(a, b, unknown)) return true;
  return !fs::exists(a, unknown) && !fs::exists(b, unknown) &&
         fs::weakly_canonical(fs::absolute(a, unknown), unknown) ==
             fs::weakly_canonical(fs::absolute(b, unknown), unknown);
}

// Whether a file is part of an input folder: images, labels, truth and the like of a data set or a
// folder of frames. Results may be in the same folder.
bool IsPartOfInput(const fs::path& folder, const fs::path& output) {
  std::error_code unknown;
  if (!fs::is_directory(folder, unknown) || !fs::exists(output, unknown)) return false;
  const fs::path inside = fs::weakly_canonical(output, unknown)
                              .lexically_relative(fs::weakly_canonical(folder, unknown));
  if (inside.empty() || *inside.begin() == "..") return false;
  const fs::path first = *inside.begin();
  if (inside == "." || first == "depth" || first == "parts" || first == "shards") return true;
  const bool is_data_set = fs::exists(folder / "manifest.json", unknown);
  return inside == "manifest.json" || inside == "truth.jsonl" || inside == "camera.json" ||
         (!is_data_set && inside == first && LowerCaseExtension(inside) == ".png");
}

}  // namespace

void CheckOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].empty()) continue;
    for (size_t k = 0; k < i; ++k) {
      if (outputs[k].empty() || !IsSameFile(outputs[i], outputs[k])) continue;
      throw UsageError(outputs[i] + ": expected a file of its own for each output");
    }
    for (const std::string& input : inputs) {
      const fs::path file = recon::FindSkeletonFile(input);
      if (!IsSameFile(outputs[i], file) && !IsPartOfInput(file, outputs[i])) continue;
      throw UsageError(fmt::format(
          "{}: expected an output other than the inputs, found the input {}", outputs[i], input));
    }
  }
}

void CheckExtension(const char* option, const std::string& path, const char* extension) {
  if (path.empty() || HasEnding(path, extension)) return;
  throw UsageError(
      fmt::format("{}: expected a name that ends in {}, found '{}'", option, extension, path));
}

void CheckNotOtherKind(const char* option, const std::string& path, const char* extension) {
  for (const char* other : {".ossa", ".ossadb", ".ossaprior", ".ossagp", ".ossarefine", ".ossalook",
                            ".ossanet", ".ossasurface", ".ossaperson", ".ossamesh", ".oni",
                            ".jsonl", ".json", ".bvh", ".trc", ".csv", ".glb", ".png", ".html"}) {
    if (HasEnding(path, other)) CheckExtension(option, path, extension);
  }
}

void CheckSkeletonName(const std::string& path) {
  try {
    recon::CheckSkeletonExtension(path);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}

void PrintLeftovers(const std::string& path) {
  for (const fs::path& left : AtomicFile::FindLeftovers(path)) {
    PrintError(fmt::format("ossa: {}: left by an ossa that was killed: it stays, and can be read\n",
                           left.string()));
  }
}

std::string FramesText(int64_t frames, std::optional<int64_t> of) {
  return of ? fmt::format("{} of {} frames", frames, *of) : fmt::format("{} frames", frames);
}

void WriteText(const std::string& path, const std::string& text) {
  if (path.empty()) return;
  AtomicFile file(path);
  file.stream() << text;
  file.Commit();
}

void DoEach(const char* command, std::initializer_list<std::function<void()>> steps) {
  std::exception_ptr first;
  for (const auto& step : steps) {
    try {
      step();
    } catch (const std::exception& error) {
      if (first) PrintError(fmt::format("ossa {}: {}\n", command, error.what()));
      if (!first) first = std::current_exception();
    }
  }
  if (first) std::rethrow_exception(first);
}

InputError MakeKeptError(const DiskFull& full, int64_t kept, int64_t of) {
  return InputError(fmt::format("{} {} were kept", full.what(), FramesText(kept, of)));
}

InputError FinishWithWhatFits(const DiskFull& full, recon::SkeletonWriter& writer) {
  return MakeKeptError(full, writer.FinishWithWhatFits(), writer.frame_count());
}

void WriteOptions::AddTo(CLI::App& app) {
  app.add_option("--bvh-names", names,
                 "joint names of a .bvh: sdk (default), or a humanoid that other programs "
                 "recognise: cmu, mixamo, vrm; of a .glb: vrm (default), cmu or mixamo")
      ->check(CLI::IsMember({"sdk", "cmu", "mixamo", "vrm"}));
  app.add_option("--mesh", mesh,
                 ".ossamesh of 'ossa surface', the skin of a .glb, or none (default: the shipped "
                 "one)");
}

void WriteOptions::AddSurfaceTo(CLI::App& app) {
  app.add_option(
      "--surface", surface,
      ".ossasurface of 'ossa surface' to which --mesh belongs (default: the shipped one)");
  needs_mesh = true;
}

void WriteOptions::Check(const std::string& out) const {
  const bool is_glb = LowerCaseExtension(out) == ".glb";
  if (!names.empty() && !is_glb && LowerCaseExtension(out) != ".bvh") {
    throw Contradiction("--bvh-names " + names + ": expected --out FILE.bvh or FILE.glb with it");
  }
  if (names == "sdk" && is_glb) {
    throw Contradiction("--bvh-names sdk: expected vrm, cmu or mixamo with --out FILE.glb");
  }
  if (!mesh.empty() && !is_glb && !has_page) {
    throw Contradiction("--mesh " + mesh + ": expected --out FILE.glb with it");
  }
  if (!surface.empty() && (is_glb || needs_mesh) && mesh.empty()) {
    throw Contradiction("--surface " + surface +
                        ": expected its skin with it, --mesh FILE.ossamesh, or --mesh none");
  }
}

recon::SkeletonWriteOptions WriteOptions::For(const std::string& out) const {
  const bool is_glb = LowerCaseExtension(out) == ".glb";
  // Both also apply to the fit and the page, whatever is written.
  return tracker::LoadWriteOptions(out, {names, is_glb ? surface : "", is_glb ? mesh : ""});
}

void WriteSkeletonsThatFit(const std::string& path, const recon::SkeletonSequence& sequence,
                           const recon::SkeletonWriteOptions& options) {
  recon::SkeletonWriter writer(path, options);
  try {
    for (const recon::SkeletonFrame& frame : sequence.frames) writer.Write(frame);
    writer.Finish();
  } catch (const DiskFull& full) {
    throw FinishWithWhatFits(full, writer);
  }
}

}  // namespace ossa::commands
