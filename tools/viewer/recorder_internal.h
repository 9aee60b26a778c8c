#pragma once
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "depth/image/depth_frame.h"
#include "depth/sensor/oni_recorder.h"

namespace ossa::viewer {

/// The name, by the local time, of a recording that begins now. Unique in the folder, also within
/// one second and in the repeated hour when daylight saving ends.
std::string NameOfNewFile(const std::filesystem::path& folder, std::time_t now);

/// The record button: switched by pages, fed with frames by the viewer. Used from any thread.
class Recorder {
 public:
  explicit Recorder(std::optional<std::filesystem::path> folder);
  ~Recorder();

  void Request(bool on);
  /// Records the frame if recording is on. Never throws for a frame that cannot be recorded or a
  /// full disk: recording ends, keeps the frames before, and status() says so.
  void Take(const depth::DepthFrame& frame);
  bool possible() const { return folder_.has_value(); }
  bool requested() const;
  /// The file being written or written last, or the error; empty: nothing was recorded.
  std::string status() const;

 private:
  void Begin(const depth::DepthFrame& frame);
  void End();
  void WriteFrame(const depth::DepthFrame& frame);
  void AbortOnError(const std::function<void()>& step);
  void Abort(const std::string& why);

  std::optional<std::filesystem::path> folder_;
  mutable std::mutex mutex_;  // guards all below
  bool requested_ = false;
  std::string status_;
  std::unique_ptr<depth::OniRecorder> writing_;
};

}  // namespace ossa::viewer
