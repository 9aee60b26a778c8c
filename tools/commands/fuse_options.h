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

/// How the skeletons of several cameras become one, the same for `ossa fuse` and `ossa track`.
struct FuseArguments {
  std::string extrinsics = "auto";  // or a file
  std::string save_extrinsics;
  recon::EstimateExtrinsicsOptions estimate;

  /// --extrinsics, --save-extrinsics and --max-offset.
  void AddTo(CLI::App& app);
  /// Before hours of work: throws UsageError for a name that ends as another kind of file, and
  /// InputError for an output that cannot be written and a file that is not of these recordings.
  void Check(std::span<const std::string> sources) const;
  /// The file to be read; "" for auto.
  std::string File() const { return extrinsics == "auto" ? "" : extrinsics; }
};

struct FusedRecordings {
  recon::SkeletonSequence skeletons;
  recon::Extrinsics cameras;
};

/// Fuses recordings, the first one's camera before: reads or finds where the cameras are, and says
/// what it found unless quiet. `sources` are the recordings' names. Throws InputError.
FusedRecordings FuseRecordings(const FuseArguments& arguments, std::span<const std::string> sources,
                               std::span<const recon::SkeletonSequence> recordings, bool quiet);

/// Writes what --out (empty: nothing) and --save-extrinsics ask for, either whatever befalls the
/// other. `command` is whose failures are said. Throws InputError.
void WriteFused(const char* command, const FuseArguments& arguments, const std::string& out,
                const FusedRecordings& fused, const recon::SkeletonWriteOptions& options);

}  // namespace ossa::commands
