#pragma once
#include <span>
#include <string>
#include <vector>

#include "recon/fuse/estimate_extrinsics.h"
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

/// Fuses recordings, the first one's camera before: reads or finds where the cameras are, says what
/// it found unless quiet, and saves it where asked. `sources` are the recordings' names. Throws
/// InputError.
recon::SkeletonSequence FuseRecordings(const FuseArguments& arguments,
                                       std::span<const std::string> sources,
                                       std::span<const recon::SkeletonSequence> recordings,
                                       bool quiet);

}  // namespace ossa::commands
