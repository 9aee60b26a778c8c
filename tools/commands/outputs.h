#pragma once
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "depth/base/atomic_file.h"
#include "depth/base/error.h"
#include "recon/files/skeleton_writer.h"

namespace ossa::commands {

/// Throws UsageError if two outputs are the same file, or an output is one of the inputs, or a file
/// that an input folder consists of: it would be overwritten. Outputs may be folders. Empty names
/// are options that were not given; `#truth` and similar suffixes of an input's name are ignored.
void CheckOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

// Rules for output names, the same for all options: where the kind is determined by content
// (models, databases and other learned files) or by the option (--json), any name except one with
// the extension of another kind; where it is determined by name (.oni, .png, .html), a name with
// this extension. The name is empty for an option that was not given.

/// Throws UsageError for a name without this extension.
void CheckExtension(const char* option, const std::string& path, const char* extension);

/// Throws UsageError for a name with the extension of another kind of file that ossa writes.
void CheckNotOtherKind(const char* option, const std::string& path, const char* extension);

/// Throws UsageError for a name without the extension of a skeleton format that can be written.
void CheckSkeletonName(const std::string& path);

/// Prints a line for each leftover of this output from a killed run, which is kept.
void PrintLeftovers(const std::string& path);

/// "27 of 150 frames"; "27 frames" if the total is unknown.
std::string FramesText(int64_t frames, std::optional<int64_t> of);

/// Writes the file atomically; an empty name is an option that was not given.
void WriteText(const std::string& path, const std::string& text);

/// Runs all tasks even if some fail: throws the first failure, after the others were printed under
/// the name of `command`.
void DoEach(const char* command, std::initializer_list<std::function<void()>> steps);

/// A message about a full disk and the number of frames kept.
InputError MakeKeptError(const DiskFull& full, int64_t kept, int64_t of);

/// Finishes a file on a full disk after its last complete frame; throws with the number of frames
/// kept.
InputError FinishWithWhatFits(const DiskFull& full, recon::SkeletonWriter& writer);

/// The options --bvh-names and --mesh for writing skeletons.
struct WriteOptions {
  std::string names, mesh;
  std::string surface;      // the surface that --mesh belongs to; "": the shipped one
  bool needs_mesh = false;  // --surface goes with --mesh only
  bool has_page = false;    // also shown in a browser, with the same skin
  void AddTo(CLI::App& app);
  /// Adds --surface, for commands without a surface fit.
  void AddSurfaceTo(CLI::App& app);
  /// Throws Contradiction for a given option that the format of `out` does not use.
  void Check(const std::string& out) const;
  /// Loads the skin for a .glb. Throws InputError.
  recon::SkeletonWriteOptions For(const std::string& out) const;
};

/// As recon::WriteSkeletons, but keeps the complete frames on a full disk.
void WriteSkeletonsThatFit(const std::string& path, const recon::SkeletonSequence& sequence,
                           const recon::SkeletonWriteOptions& options = {});

}  // namespace ossa::commands
