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

/// Outcome of a Read. All but kFrame leave ReadResult::frame empty.
enum class ReadStatus {
  kFrame,
  kTimeout,       // no frame within the timeout; read again
  kEnd,           // a recording's last frame has been read
  kDisconnected,  // the device was unplugged; the source keeps looking for it while it is read
};

/// A frame, or why there is none.
struct ReadResult {
  ReadStatus status = ReadStatus::kTimeout;
  DepthFrame frame;
  // Frames lost since the frame read before; with kEnd, after the last one. Each counts once.
  int64_t dropped = 0;
};

/// A source of depth images: an OpenNI2 device, a recording (.oni, .mkv, bags of ROS), a folder of
/// PNGs or a single PNG, a data set, another program's images through a pipe.
class FrameSource {
 public:
  virtual ~FrameSource() = default;

  /// Waits at most `timeout` for the next frame. Throws InputError when the source is damaged.
  virtual ReadResult Read(std::chrono::milliseconds timeout) = 0;

  /// Intrinsics of the following frames; if a frame's own camera differs, that one is valid.
  virtual const Camera& camera() const = 0;

  /// True for devices, whose frames arrive in real time and are lost when not read, and for pipes,
  /// whose writer waits.
  virtual bool is_live() const = 0;

  /// Number of frames of a recording; nullopt for devices and for files that do not state it.
  virtual std::optional<int64_t> frame_count() const = 0;
};

enum class NoteKind {
  kInfo,     // an assumption, or something ignored
  kWarning,  // data that were lost, or an assumption that is probably wrong
};

/// Encoding of 16-bit depth images that do not state it.
enum class DepthFormat {
  kPlain,      // depth in units of 1 / SourceOptions::depth_scale metres
  kSwapped,    // the same, bytes swapped
  kInverted,   // the same, subtracted from SourceOptions::inverted_from
  kDisparity,  // raw shifts of a Kinect v1, 11 bits, 2047 for no reading
};

/// How a SOURCE is opened. Options without a value are detected in the source.
struct SourceOptions {
  std::optional<CameraChoice> camera = {};   // overrides the source's own
  std::chrono::milliseconds device_wait{0};  // how long to wait for a device to appear
  // Called ten times a second meanwhile, and before a stream's first images; empty: true.
  std::function<bool()> keep_waiting = {};
  // After this time without a frame OpenNI2's player counts as hung and the file as damaged. The
  // player itself waits 3 s for a frame of a truncated file.
  std::chrono::milliseconds player_patience{10000};
  // Depth units per metre. Default: the unit that a recording states, else millimetres; images that
  // state none and cannot be millimetres of people are refused.
  std::optional<double> depth_scale = {};
  DepthFormat depth_format = DepthFormat::kPlain;
  int inverted_from = 65535;       // value of 0 mm, 1 to 65535; by definition the largest
  std::optional<double> fps = {};  // frame rate, Hz; replaces the recording's own times
  // The source's images are as a mirror shows them, u = cx + fx x/z, and so is its camera, stated
  // or chosen by numbers: both are delivered as the sensor looks.
  bool mirrored = false;
  // Called with the camera if it was guessed from the image size; may be empty.
  std::function<void(const CameraGuess&)> guessed = {};
  // Called with each note, one line for the user; may be empty.
  std::function<void(NoteKind, const std::string&)> note = {};

  /// Throws InputError naming the first value out of range.
  void Check() const;
};

/// Whether SOURCE is standard input, "-", or a named pipe: images that another program sends.
bool IsStream(const std::string& source);

/// Whether the path is a stream or a file of depth images by its extension, in any case (.oni,
/// .xef, .mkv, .bag, .db3, .mcap, .png, .tif, .npy and so on), or a folder of images, a ROS 2 bag
/// or a scan. Throws std::filesystem::filesystem_error for a folder that cannot be read.
bool IsRecording(const std::filesystem::path& path);

/// Opens SOURCE: "openni:", "openni:URI", "FILE.oni", "FILE.xef", "FILE.mkv", a bag of ROS
/// (FILE.bag, FILE.db3, FILE.mcap, a folder of such files) or "BAG#/topic", arrays of NumPy, MATLAB
/// or HDF5 (FILE.npy, .npz, .mat, .h5) or "FILE#name", a folder of depth images (PNG, TIFF, PGM,
/// NPY), a scan or a DATASET; or one such image, a still; or "-", standard input, or a named pipe:
/// PGM images one after the other (docs/sources.md). Throws InputError naming it and what was
/// expected.
std::unique_ptr<FrameSource> OpenSource(const std::string& source,
                                        const SourceOptions& options = {});

}  // namespace ossa::depth
