#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Writes depth frames as a dump that libfreenect's fakenect plays as if a Kinect v1 were there:
/// a folder of PGM files, one of the accelerometer (level), and INDEX.txt, which comes last and
/// makes the dump complete. The depths are millimetres, for programs that ask libfreenect for
/// millimetres, as our driver does; Debian's fakenect hands them on as they are.
class FakenectDump {
 public:
  /// Makes the folder. Throws InputError when it cannot, when a dump is there already, or when the
  /// camera is not 640 × 480.
  FakenectDump(const std::filesystem::path& folder, const Camera& camera);
  /// Throws InputError for a frame of another size, and DiskFull.
  void Write(const DepthFrame& frame);
  /// Throws DiskFull.
  void Finish();
  /// In place of Finish(), after DiskFull: makes the dump one of the first frames, as many as leave
  /// room for INDEX.txt. Returns how many; 0: none.
  int64_t FinishWithWhatFits();
  int64_t frame_count() const { return static_cast<int64_t>(frames_.size()); }

 private:
  std::filesystem::path folder_;
  std::string level_;                // the accelerometer's file
  std::vector<std::string> frames_;  // their files
};

}  // namespace ossa::depth
