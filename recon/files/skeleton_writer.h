#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

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

/// Writes skeletons frame by frame, in the format of the extension: .jsonl, .csv, .trc, .bvh, .glb.
/// Memory does not grow with the recording, except for eight bytes per frame of a .trc, .bvh or
/// .glb, and a tenth of a megabyte per person. The postures of a .bvh or .glb are kept in an
/// unnamed temporary file (half a kilobyte per frame and person), and a .glb is composed in memory
/// at the end. A .glb (glTF 2.0) has a skinned humanoid per person, "person ID", with a T-pose at
/// rest, animated at the frames' own times in the skeletons' axes (camera space); people out of
/// view have scale 0. TRC and BVH hold one person per file: of several, the first is written to
/// `path` and each other one to `path` with `_ID` before the extension; all begin with the first
/// frame. The complete files appear under their names at Finish(); without it nothing is left. If
/// the process is killed, complete lines stay under the temporary name (AtomicFile).
class SkeletonWriter {
 public:
  /// Throws InputError for another extension and for a path that cannot be written.
  explicit SkeletonWriter(const std::filesystem::path& path,
                          const SkeletonWriteOptions& options = {});
  ~SkeletonWriter();

  /// Throws InputError if the frame is earlier than the one before, and then leaves it out;
  /// DiskFull if it does not fit.
  void Write(const SkeletonFrame& frame);
  /// Shape of a person by the surface fit (PersonShape); the last call counts. Only a .glb shows
  /// it; people without one have the mean shape.
  void SetShape(int id, const ShapeVector& shape);
  /// Throws InputError for a .bvh or .glb without people, and for one that would be too long to be
  /// read (gaps are filled in a .bvh). Throws DiskFull.
  void Finish();
  /// Instead of Finish(), after DiskFull: ends the file after its last complete frame; a .bvh or
  /// .glb after as many frames as fit, or up to a quarter fewer. Its temporary data on the disk are
  /// moved to memory. Returns the number of frames kept; with 0 no file is left.
  int64_t FinishWithWhatFits();
  /// Frames written.
  int64_t frame_count() const { return frame_count_; }

  /// Implementation of a format.
  class Format;

 private:
  std::filesystem::path path_;
  std::unique_ptr<Format> format_;
  std::optional<double> last_s_;  // time of the last frame
  int64_t frame_count_ = 0;
};

/// WriteSkeletons (skeleton_io.h) with options.
void WriteSkeletons(const std::filesystem::path& path, const SkeletonSequence& sequence,
                    const SkeletonWriteOptions& options);

}  // namespace ossa::recon
