#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "recon/motion/bvh.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

/// Writes skeletons as they come, in the format that the extension names: .jsonl, .csv, .trc, .bvh.
/// Memory does not grow with the recording but for eight bytes a frame of a .trc; of a .bvh, whose
/// head needs all of it, the postures wait in a file without a name (half a kilobyte a frame and
/// person). TRC and BVH hold one person a file: of several, the first goes to `path` and each other
/// to `path` with `_ID` before the extension; all begin with the first frame. The files appear
/// under their names at Finish(), whole; without it nothing is left. If the process is killed, what
/// was written until then stays under the temporary name (AtomicFile): whole lines.
class SkeletonWriter {
 public:
  /// `names`: of a .bvh. Throws InputError for another extension and for a place that cannot be
  /// written.
  explicit SkeletonWriter(const std::filesystem::path& path, BvhNames names = BvhNames::kSdk);
  ~SkeletonWriter();

  /// Throws DiskFull when it does not fit.
  void Write(const SkeletonFrame& frame);
  /// Throws InputError for a .bvh of nobody, or that would be too long to be read: a gap in a
  /// recording is filled there. Throws DiskFull.
  void Finish();
  /// In place of Finish(), after DiskFull: ends the file after the last frame that is whole in it.
  /// Returns how many frames were kept; 0: none, and nothing is left. (None of a .bvh.)
  int64_t FinishWithWhatFits();
  /// Frames written.
  int64_t frame_count() const { return frame_count_; }

  /// What one format does; see the functions above.
  class Format;

 private:
  std::unique_ptr<Format> format_;
  int64_t frame_count_ = 0;
};

}  // namespace ossa::recon
