#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// Largest depth an .oni of ours holds, millimetres. OpenNI2's own recorder silently corrupts
/// values not strictly below a stream's MAX_VALUE, and MAX_VALUE is at most 65535.
inline constexpr uint16_t kLargestOniDepth_mm = 65534;

/// Writes depth frames to an .oni recording that OpenNI2, NiViewer and ossa play back bit for bit.
/// The file appears under its name at Finish(), whole; without it nothing is left.
///
/// Beside what OpenNI2 wants it holds the exact camera and a checksum, as properties that OpenNI2
/// passes over: damage to a recording of ours is noticed, which OpenNI2 alone would not.
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
  /// Throws DiskFull when what ends the file does not fit.
  void Finish();
  /// In place of Finish(), after an InputError such as DiskFull: ends the file after the last whole
  /// frame, or so many before it that the end fits. Returns how many frames were kept; 0: none, and
  /// nothing is left. Throws InputError where the file cannot be ended for another reason.
  int64_t FinishWithWhatFits();
  int64_t frame_count() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace ossa::depth
