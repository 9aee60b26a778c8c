#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "recon/fit/body_surface.h"
#include "recon/motion/bvh.h"
#include "recon/skeleton_sequence.h"

namespace ossa::recon {

struct BodyMesh;  // recon/fit/body_mesh.h

/// Options of the formats that have some.
struct SkeletonWriteOptions {
  BvhNames names = BvhNames::kSdk;            // of a .bvh or .glb; for a .glb kSdk means VRM's
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
  /// Throws InputError for another extension and for a path that cannot be written.
  explicit SkeletonWriter(const std::filesystem::path& path,
                          const SkeletonWriteOptions& options = {});
  ~SkeletonWriter();

  /// Throws DiskFull if the frame does not fit.
  void Write(const SkeletonFrame& frame);
  /// Shape of a person by the surface fit (PersonShape); the last call counts. Only a .glb shows
  /// it; people without one have the mean shape.
  void SetShape(int id, const ShapeVector& shape);
  /// Throws InputError for a .bvh or .glb of nobody, or that would be too long to be read: a gap in
  /// a recording is filled in a .bvh. Throws DiskFull.
  void Finish();
  /// Instead of Finish(), after DiskFull: ends the file after its last complete frame; a .bvh or
  /// .glb after as many frames as there is room for, maybe a quarter less. Its temporary data on
  /// the disk are moved to memory.
  /// Returns the number of frames kept; with 0 no file is left.
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
