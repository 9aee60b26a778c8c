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

/// Throws UsageError when two outputs are one file, of which the first would be lost, or an output
/// is one of the inputs, or of the files that an input folder is made of: a recording would be
/// replaced by what was made of it. Outputs may be folders. Empty names are
/// options that were not given; `#truth` and the like after an input's name are no part of it.
void CheckOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

// Which name a file of one format may have, the same for every option: where its kind is told by
// the content (models, databases and what else is learned) or by the option (--json) any, but for
// one that ends as another kind of file; where programs tell it by the name (.oni, .png, .html) one
// that ends so. Of an option that was not given the name is empty.

/// Throws UsageError for a name that does not end so.
void CheckExtension(const char* option, const std::string& path, const char* extension);

/// Throws UsageError for a name that ends as another kind of file that ossa writes.
void CheckNotOtherKind(const char* option, const std::string& path, const char* extension);

/// Throws UsageError for a name whose extension is of no skeleton format that is written.
void CheckSkeletonName(const std::string& path);

/// Says of each file that an ossa that was killed left of this output that it is there, and stays.
void SayLeftovers(const std::string& path);

/// "27 of 150 frames"; "27 frames" where nobody knows of how many.
std::string FramesText(int64_t frames, std::optional<int64_t> of);

/// The file appears when it is complete; an empty name is an option that was not given.
void WriteText(const std::string& path, const std::string& text);

/// Does each, whatever befell another: throws the first failure, after `command` said the others.
void DoEach(const char* command, std::initializer_list<std::function<void()>> steps);

/// What did not fit, and how many frames of it are kept.
InputError NamingWhatIsKept(const DiskFull& full, int64_t kept, int64_t of);

/// Ends a file that does not fit after its last whole frame; the failure says how many are kept.
InputError KeepWhatFits(const DiskFull& full, recon::SkeletonWriter& writer);

/// The options --bvh-names and --mesh: how skeletons are written.
struct WriteOptions {
  std::string names, mesh;
  std::string surface;    // whose skin --mesh is; "": the shipped one
  bool has_page = false;  // shown in browsers, too, which wear the same skin
  void AddTo(CLI::App& app);
  /// --surface, of commands that have no fit to pose one.
  void AddSurfaceTo(CLI::App& app);
  /// Throws UsageError where one was given that `out` does not read.
  void Check(const std::string& out) const;
  /// Loads what a .glb's people wear. Throws InputError.
  recon::SkeletonWriteOptions For(const std::string& out) const;
};

/// recon::WriteSkeletons that keeps what fits.
void WriteSkeletonsThatFit(const std::string& path, const recon::SkeletonSequence& sequence,
                           const recon::SkeletonWriteOptions& options = {});

}  // namespace ossa::commands
