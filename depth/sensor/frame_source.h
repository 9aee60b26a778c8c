#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "depth/image/camera_presets.h"
#include "depth/image/depth_frame.h"

namespace ossa::depth {

/// What one Read brought. All but kFrame leave ReadResult::frame empty.
enum class ReadStatus {
  kFrame,
  kTimeout,       // nothing within the time asked; ask again
  kEnd,           // a recording's last frame has been given
  kDisconnected,  // the device was unplugged; the source keeps looking for it while it is read
};

/// What one Read gives: a frame, or why there is none.
struct ReadResult {
  ReadStatus status = ReadStatus::kTimeout;
  DepthFrame frame;
  // Frames lost between the last one given and this one, or, with kEnd, after the last; told once.
  int64_t dropped = 0;
};

/// Where depth images come from: an OpenNI2 device, an .oni, .mkv or .bag file, a folder of PNGs or
/// one of them, a data set.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Waits at most `timeout` for the next frame. Throws InputError when the source is damaged.
  virtual ReadResult Read(std::chrono::milliseconds timeout) = 0;

  /// Intrinsics of the frames to come; a frame's own camera rules should they ever differ.
  virtual const Camera& camera() const = 0;

  /// True for devices: frames come in real time and are lost when not read.
  virtual bool is_live() const = 0;

  /// Number of frames of a recording; nullopt for devices and for files that do not know.
  virtual std::optional<int64_t> frame_count() const = 0;
};

enum class NoteKind {
  kInfo,     // what was assumed or passed over
  kWarning,  // what was lost
};

/// What the 16-bit numbers of images are that do not say it themselves.
enum class DepthFormat {
  kPlain,      // lengths, SourceOptions::depth_scale to the metre
  kSwapped,    // the same, with the bytes of each exchanged
  kInverted,   // the same, subtracted from SourceOptions::inverted_from
  kDisparity,  // raw shifts of a Kinect v1, 11 bits, 2047 for no reading
};

/// How a SOURCE is opened; what is left out is found in the source itself.
struct SourceOptions {
  std::optional<CameraChoice> camera = {};   // overrides whatever the source says
  std::chrono::milliseconds device_wait{0};  // how long to wait for a device to appear
  std::function<bool()> keep_waiting = {};   // asked ten times a second meanwhile; empty: yes
  // A recording's player that is silent for longer hangs inside OpenNI2: the file is damaged. The
  // player itself waits 3 s for a frame of a file that is merely cut short.
  std::chrono::milliseconds player_patience{10000};
  // Units to the metre. Left out, they are millimetres, or the unit that a recording states; images
  // that state none and cannot be millimetres of people are refused.
  std::optional<double> depth_scale = {};
  DepthFormat depth_format = DepthFormat::kPlain;
  int inverted_from = 65535;       // that stands for 0 mm, 1 to 65535; by definition the largest
  std::optional<double> fps = {};  // frames a second, whatever the recording says of its times
  // Told the camera where neither this nor the source says it; empty: nobody is.
  std::function<void(const CameraGuess&)> guessed = {};
  // One line for the user each; empty: nobody is told.
  std::function<void(NoteKind, const std::string&)> note = {};

  /// Throws InputError naming the first number that cannot be.
  void Check() const;
};

/// A file of depth images by its name, in capitals or not (FILE.oni, FILE.mkv, FILE.bag, FILE.png),
/// or a folder of the latter. A folder that cannot be read throws
/// std::filesystem::filesystem_error.
bool IsRecording(const std::filesystem::path& path);

/// Opens SOURCE: "openni:", "openni:URI", "FILE.oni", "FILE.mkv", "FILE.bag", "FILE.bag#/topic", a
/// folder of 16-bit PNGs, or a DATASET folder; or one such PNG, a still (docs/sources.md). Throws
/// InputError naming it and what was expected.
std::unique_ptr<FrameSource> OpenSource(const std::string& source,
                                        const SourceOptions& options = {});

}  // namespace ossa::depth
