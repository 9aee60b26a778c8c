#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "depth/sensor/frame_source.h"
#include "tools/python/native/arrays.h"

namespace ossa::python {

using Notes = std::vector<std::pair<std::string, std::string>>;  // "info" or "warning", text

/// Collects the notes of readers, from any thread, while the GIL is released.
class NoteBook {
 public:
  void Add(depth::NoteKind kind, const std::string& text);
  Notes Take();

 private:
  std::mutex mutex_;
  Notes notes_;
};

/// "frame", "timeout", "end" or "disconnected".
const char* NameOf(depth::ReadStatus status);

/// A SOURCE that one thread at a time reads; others wait. A read throws if another thread closes
/// the source.
class Source {
 public:
  Source(const std::string& name, const py::dict& given);

  /// Reads the next frame. Called without the GIL.
  depth::ReadResult Next(int timeout_ms);
  /// (status, depth_mm | None, camera, time_s, dropped)
  py::tuple Read(int timeout_ms);
  void Close();
  py::tuple Camera() {
    return ToTuple(Locked([this](auto& frames) { return taken_.value_or(frames.camera()); }));
  }
  bool IsLive() {
    return Locked([](auto& frames) { return frames.is_live(); });
  }
  std::optional<int64_t> FrameCount() {
    return Locked([](auto& frames) { return frames.frame_count(); });
  }
  /// Camera of all further frames, instead of the source's own.
  void TakeCamera(const py::tuple& camera);
  Notes TakeNotes() { return notes_.Take(); }

 private:
  depth::FrameSource& Opened();
  template <typename Ask>
  std::invoke_result_t<Ask, depth::FrameSource&> Locked(const Ask& ask) {
    const GilReleased free;
    const std::lock_guard lock(mutex_);
    return ask(Opened());
  }

  const std::string name_;
  NoteBook notes_;  // declared before its writers
  std::mutex mutex_;
  std::unique_ptr<depth::FrameSource> frames_;
  std::optional<depth::Camera> taken_;
};

}  // namespace ossa::python
