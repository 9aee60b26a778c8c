#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Largest depth that OniRecorder writes, millimetres. OpenNI2's own recorder silently corrupts
/// values not strictly below a stream's MAX_VALUE, and MAX_VALUE is at most 65535.
inline constexpr uint16_t kLargestOniDepth_mm = 65534;

/// Writes depth frames to an .oni recording that OpenNI2, NiViewer and ossa play back bit for bit.
/// The complete file appears under its name at Finish(); without that nothing is left.
///
/// The file also holds the exact camera and a checksum, as properties that OpenNI2 ignores, so that
/// ossa detects damage that OpenNI2 does not.
class OniRecorder {
 public:
  /// All frames must have the camera's size. Throws InputError when the file cannot be written or
  /// when OpenNI2's player could not hold a frame (more than 2.88 million pixels).
  OniRecorder(const std::filesystem::path& path, const Camera& camera, int frames_per_second = 30);
  ~OniRecorder();

  /// Throws InputError naming the frame when its size is another, when it holds a depth that the
  /// format would corrupt (above kLargestOniDepth_mm), when it comes out larger than a player can
  /// hold (noise all over a frame of 1600 × 1200), and DiskFull when it does not fit.
  void Write(const DepthFrame& frame);
  /// Throws DiskFull when the end of the file does not fit.
  void Finish();
  /// Instead of Finish(), after an InputError such as DiskFull: ends the file after the last
  /// complete frame, or earlier if its end needs the room. Returns the number of frames kept; with
  /// 0 no file is left. Throws InputError if the file cannot be ended for another reason.
  int64_t FinishWithWhatFits();
  int64_t frame_count() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::depth
