#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "recon/fit/body_surface.h"
#include "recon/motion/bvh.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

struct BodyMesh;  // recon/fit/body_mesh.h

/// How skeletons are written, where the format has a choice.
struct SkeletonWriteOptions {
  BvhNames names = BvhNames::kSdk;            // of a .bvh or .glb; a .glb's kSdk is VRM's
  std::shared_ptr<const BodyMesh> body = {};  // the skin of a .glb; none: bones alone
};

/// Writes skeletons as they come, in the format that the extension names: .jsonl, .csv, .trc, .bvh,
/// .glb. Memory does not grow with the recording but for eight bytes a frame of a .trc, .bvh or
/// .glb; of a .bvh or .glb, whose head needs all of it, the postures wait in a file without a name
/// (half a kilobyte a frame and person), and a .glb is put together in memory at the end. A .glb
/// (glTF 2.0) is a skinned humanoid for each person, "person ID", at rest in a T-pose, in motion at
/// the frames' own times from the first frame on, in the skeletons' own axes (camera space); who is
/// out of view has no size. TRC and BVH hold one person a file: of several, the first goes to
/// `path` and each other to `path` with `_ID` before the extension; all begin with the first frame.
/// The files appear under their names at Finish(), whole; without it nothing is left. If the
/// process is killed, what was written until then stays under the temporary name (AtomicFile):
/// whole lines.
class SkeletonWriter {
 public:
  /// Throws InputError for another extension and for a place that cannot be written.
  explicit SkeletonWriter(const std::filesystem::path& path,
                          const SkeletonWriteOptions& options = {});
  ~SkeletonWriter();

  /// Throws DiskFull when it does not fit.
  void Write(const SkeletonFrame& frame);
  /// The shape of the body that a surface fit found (PersonShape); the last one said counts. Only a
  /// .glb shows it; people of whom none is known have the mean body's.
  void SetShape(int id, const ShapeVector& shape);
  /// Throws InputError for a .bvh or .glb of nobody, or that would be too long to be read: a gap in
  /// a recording is filled in a .bvh. Throws DiskFull.
  void Finish();
  /// In place of Finish(), after DiskFull: ends the file after the last frame that is whole in it;
  /// of a .bvh or .glb, after one for which there is room, maybe a quarter of all before that. What
  /// waited for it on the disk is taken into memory. Returns how many frames were kept; 0: none,
  /// and nothing is left.
  int64_t FinishWithWhatFits();
  /// Frames written.
  int64_t frame_count() const { return frame_count_; }

  /// What one format does; see the functions above.
  class Format;

 private:
  std::unique_ptr<Format> format_;
  int64_t frame_count_ = 0;
};

/// WriteSkeletons (skeleton_io.h) with options.
void WriteSkeletons(const std::filesystem::path& path, const SkeletonSequence& sequence,
                    const SkeletonWriteOptions& options);

}  // namespace ossa::recon
