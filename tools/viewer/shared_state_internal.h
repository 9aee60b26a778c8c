#pragma once
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "tools/viewer/frame_store_internal.h"
#include "tools/viewer/recorder_internal.h"
#include "tools/viewer/viewer.h"

namespace ossa::viewer {

/// State shared by the thread of the tracker and the thread that serves browsers.
struct SharedState {
  explicit SharedState(const ViewerOptions& options);

  const ViewerOptions options;
  FrameStore store;
  Recorder recorder;

  /// The state as JSON: what is shown, how many frames there are, settings, recording.
  std::string StateJson() const;
  /// Skeleton JSONL of up to `count` frames from `from` on.
  std::string FinalLines(int64_t from, int64_t count) const;
  std::string OverlayLines(size_t overlay, int64_t from, int64_t count) const;

  void ChangeSettings(const Settings& settings);
  std::optional<Settings> TakeSettings();
  void Refuse(const Settings& still, const std::string& why);
  std::optional<Settings> settings() const;

 private:
  const std::vector<std::vector<std::string>> overlay_lines_;  // one per overlay, one per frame
  const int64_t begun_ms_;    // since 1970: identifies the run to a page that was left open
  mutable std::mutex mutex_;  // guards all below
  std::optional<Settings> settings_;
  bool changed_ = false;
  std::string refused_;  // why the last change of settings failed
};

}  // namespace ossa::viewer
