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

/// Readers tell of what they assume while the GIL is released, from whichever thread.
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

/// A SOURCE that one thread at a time reads; others wait. Whoever reads when another closes it is
/// told so.
class Source {
 public:
  Source(const std::string& name, const py::dict& given);

  /// The next frame as it was read. Called without the GIL.
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
  /// Frames to come are of this one, whatever the source says.
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
  NoteBook notes_;  // before what writes into it
  std::mutex mutex_;
  std::unique_ptr<depth::FrameSource> frames_;
  std::optional<depth::Camera> taken_;
};

}  // namespace ossa::python
