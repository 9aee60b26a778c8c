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

/// The name, by the local time of day, of a recording that begins now: of no file in the folder
/// yet, also in the same second and in the hour that is there twice in autumn.
std::string NameOfNewFile(const std::filesystem::path& folder, std::time_t now);

/// The record button: asked for by pages, fed by whoever has the frames. Used from any thread.
class Recorder {
 public:
  explicit Recorder(std::optional<std::filesystem::path> folder);
  ~Recorder();

  void Ask(bool on);
  /// Takes the frame where recording was asked for. Never throws for a frame that cannot be
  /// recorded or a bad disk: recording ends, keeps what came before, and says so.
  void Take(const depth::DepthFrame& frame);
  bool possible() const { return folder_.has_value(); }
  bool asked() const;
  /// Of the file that is written or was last, or what went wrong; empty: nothing was recorded.
  std::string said() const;

 private:
  void Begin(const depth::DepthFrame& frame);
  void End();
  void Try(const depth::DepthFrame& frame);
  void GiveUpWhereItFails(const std::function<void()>& step);
  void GiveUp(const std::string& why);

  std::optional<std::filesystem::path> folder_;
  mutable std::mutex mutex_;  // guards all below
  bool asked_ = false;
  std::string said_;
  std::unique_ptr<depth::OniRecorder> writing_;
};

}  // namespace ossa::viewer
