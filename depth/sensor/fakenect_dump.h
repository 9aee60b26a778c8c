#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Writes depth frames as a dump that libfreenect's fakenect plays like a Kinect v1: a folder of
/// PGM files, a file of the accelerometer (level), and INDEX.txt, which is written last and makes
/// the dump complete. Depths are millimetres, for programs that request millimetres, as our driver
/// does; Debian's fakenect passes them on unchanged.
class FakenectDump {
 public:
  /// Creates the folder. Throws InputError if that fails, if there is a dump already, or if the
  /// camera is not 640 × 480.
  FakenectDump(const std::filesystem::path& folder, const Camera& camera);
  /// Throws InputError for a frame of another size, and DiskFull.
  void Write(const DepthFrame& frame);
  /// Throws DiskFull.
  void Finish();
  /// Instead of Finish(), after DiskFull: completes the dump with the first frames, as many as
  /// leave room for INDEX.txt. Returns their number; 0: none.
  int64_t FinishWithWhatFits();
  int64_t frame_count() const { return static_cast<int64_t>(frames_.size()); }

 private:
  std::filesystem::path folder_;
  std::string level_;                // name of the accelerometer file
  std::vector<std::string> frames_;  // names of the frame files
};

}  // namespace ossa::depth
