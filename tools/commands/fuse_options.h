#pragma once
#include <span>
#include <string>
#include <vector>

#include "recon/files/skeleton_writer.h"
#include "recon/fuse/estimate_extrinsics.h"
#include "recon/fuse/extrinsics.h"
#include "recon/skeleton_sequence.h"

namespace CLI {
class App;
}

namespace ossa::commands {

/// How the skeletons of several cameras are fused, the same for `ossa fuse` and `ossa track`.
struct FuseArguments {
  std::string extrinsics = "auto";  // or a file
  std::string save_extrinsics;
  recon::EstimateExtrinsicsOptions estimate;
  bool states_max_offset = false;

  /// Adds --extrinsics, --save-extrinsics and --max-offset.
  void AddTo(CLI::App& app);
  /// To be called before tracking: throws UsageError for a name with the extension of another kind
  /// of file, a recording given twice and a largest offset that is not read, and InputError for an
  /// output that cannot be written and a file that does not match these recordings.
  void Check(std::span<const std::string> sources) const;
  /// The file to read; "" for auto.
  std::string File() const { return extrinsics == "auto" ? "" : extrinsics; }
};

struct FusedRecordings {
  recon::SkeletonSequence skeletons;
  recon::Extrinsics cameras;
};

/// Fuses recordings in the camera space of the first: reads or estimates the extrinsics, and prints
/// the estimate unless quiet. `sources` are the recordings' names. Throws InputError.
FusedRecordings FuseRecordings(const FuseArguments& arguments, std::span<const std::string> sources,
                               std::span<const recon::SkeletonSequence> recordings, bool quiet);

/// Writes the files of --out (empty: none) and --save-extrinsics, each even if the other fails.
/// `command` is named in error messages. Throws InputError.
void WriteFused(const char* command, const FuseArguments& arguments, const std::string& out,
                const FusedRecordings& fused, const recon::SkeletonWriteOptions& options);

}  // namespace ossa::commands
