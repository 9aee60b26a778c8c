#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>

#include "recon/files/skeleton_jsonl.h"
#include "tools/viewer/shared_state_internal.h"

namespace ossa::viewer {
namespace {

std::vector<std::vector<std::string>> LinesOf(const std::vector<Overlay>& overlays) {
  std::vector<std::vector<std::string>> all;
  for (const Overlay& overlay : overlays) {
    std::vector<std::string>& lines = all.emplace_back();
    for (const recon::SkeletonFrame& frame : overlay.sequence.frames) {
      lines.push_back(recon::SkeletonJsonLine(frame));
    }
  }
  return all;
}

int64_t Now_ms() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

nlohmann::json JsonOf(const Settings& settings) {
  return {{"method", settings.method},
          {"smoothing", settings.smoothing},
          {"seated", settings.seated},
          {"near", settings.near_range},
          {"users", settings.users}};
}

}  // namespace

SharedState::SharedState(const ViewerOptions& with)
    : options(with),
      store(with.keeps, with.forest, with.body),
      recorder(with.recordings),
      overlay_lines_(LinesOf(with.overlays)),
      begun_ms_(Now_ms()),
      settings_(with.settings) {}

std::string SharedState::StateJson() const {
  const FrameStore::Count count = store.count();
  nlohmann::json json = {{"name", options.name},
                         {"begun_ms", begun_ms_},
                         {"kept", store.keeps()},
                         {"frames", count.frames},
                         {"generation", count.generation},
                         {"complete", count.complete},
                         {"expected", nullptr},
                         {"overlays", nlohmann::json::array()},
                         {"methods", options.methods},
                         {"smoothings", options.smoothings},
                         {"settings", nullptr},
                         {"recording",
                          {{"possible", recorder.possible()},
                           {"on", recorder.requested()},
                           {"status", recorder.status()}}}};
  if (options.expected_frames) json["expected"] = *options.expected_frames;
  for (size_t i = 0; i < overlay_lines_.size(); ++i) {
    json["overlays"].push_back(
        {{"name", options.overlays[i].name}, {"frames", overlay_lines_[i].size()}});
  }
  const std::lock_guard lock(mutex_);
  if (settings_) json["settings"] = JsonOf(*settings_);
  json["refused"] = refused_;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string SharedState::FinalLines(int64_t from, int64_t count) const {
  std::string text;
  const int64_t frames = store.keeps() ? store.count().frames : 0;
  for (int64_t i = from; i < std::min(frames, from + count); ++i) text += store.Line(i) + '\n';
  return text;
}

std::string SharedState::OverlayLines(size_t overlay, int64_t from, int64_t count) const {
  std::string text;
  if (overlay >= overlay_lines_.size()) return text;
  const std::vector<std::string>& lines = overlay_lines_[overlay];
  const int64_t end = std::min(static_cast<int64_t>(lines.size()), from + count);
  for (int64_t i = from; i < end; ++i) text += lines[static_cast<size_t>(i)] + '\n';
  return text;
}

void SharedState::ChangeSettings(const Settings& settings) {
  const std::lock_guard lock(mutex_);
  refused_.clear();
  if (!settings_ || *settings_ == settings) return;
  settings_ = settings;
  changed_ = true;
}

std::optional<Settings> SharedState::TakeSettings() {
  const std::lock_guard lock(mutex_);
  if (!changed_) return std::nullopt;
  changed_ = false;
  return settings_;
}

void SharedState::Refuse(const Settings& still, const std::string& why) {
  const std::lock_guard lock(mutex_);
  settings_ = still;
  refused_ = why;
}

std::optional<Settings> SharedState::settings() const {
  const std::lock_guard lock(mutex_);
  return settings_;
}

}  // namespace ossa::viewer
