// Cameras by name, and the frames of a SOURCE.
#include "depth/sensor/frame_source.h"

#include <pybind11/stl.h>

#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/image/camera_io.h"
#include "depth/sensor/depth_coding.h"
#include "tools/python/native/arrays.h"
#include "tools/python/native/native.h"
#include "tools/python/native/source.h"

namespace ossa::python {
namespace {

using std::chrono::milliseconds;

// Inverse of ToTuple().
depth::Camera CameraFrom(const py::handle& tuple) {
  const auto c = tuple.cast<std::tuple<double, double, double, double, int, int>>();
  return {std::get<4>(c), std::get<5>(c), std::get<0>(c),
          std::get<1>(c), std::get<2>(c), std::get<3>(c)};
}

}  // namespace

const char* NameOf(depth::ReadStatus status) {
  switch (status) {
    case depth::ReadStatus::kFrame:
      return "frame";
    case depth::ReadStatus::kTimeout:
      return "timeout";
    case depth::ReadStatus::kEnd:
      return "end";
    case depth::ReadStatus::kDisconnected:
      return "disconnected";
  }
  return "";
}

depth::SourceOptions ReadSourceOptions(const py::dict& given) {
  depth::SourceOptions options;
  if (given.contains("camera")) {
    const auto camera = given["camera"];
    if (py::isinstance<py::str>(camera)) {
      options.camera = depth::ParseCamera(camera.cast<std::string>());
    } else {
      options.camera = CameraFrom(camera);
    }
  }
  if (given.contains("depth_scale")) options.depth_scale = given["depth_scale"].cast<double>();
  if (given.contains("fps")) options.fps = given["fps"].cast<double>();
  const auto coding = depth::ParseDepthFormat(given["depth_format"].cast<std::string>());
  options.depth_format = coding.format;
  options.inverted_from = coding.inverted_from;
  options.mirrored = given["mirrored"].cast<bool>();
  options.device_wait = milliseconds(static_cast<int64_t>(1000.0 * given["wait_s"].cast<double>()));
  options.keep_waiting = CheckSignals;
  if (given.contains("keep_waiting")) {
    // Borrowed: an owned reference would be released without the GIL.
    options.keep_waiting = [ask = py::object(given["keep_waiting"]).ptr()] {
      return CheckSignalsAndAsk(ask);
    };
  }
  return options;
}

void NoteBook::Add(depth::NoteKind kind, const std::string& text) {
  const std::lock_guard lock(mutex_);
  notes_.emplace_back(kind == depth::NoteKind::kWarning ? "warning" : "info", text);
}

Notes NoteBook::Take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(notes_, {});
}

Source::Source(const std::string& name, const py::dict& given) : name_(name) {
  depth::SourceOptions options = ReadSourceOptions(given);
  options.note = [this](depth::NoteKind kind, const std::string& text) { notes_.Add(kind, text); };
  frames_ = Interruptible([&] { return depth::OpenSource(name, options); });
}

depth::FrameSource& Source::Opened() {
  if (!frames_)
    throw InputError(OnOneLine(name_) + ": expected a source that is open, found it closed");
  return *frames_;
}

depth::ReadResult Source::Next(int timeout_ms) {
  const std::lock_guard lock(mutex_);
  depth::ReadResult read = Opened().Read(milliseconds(timeout_ms));
  if (taken_ && read.status == depth::ReadStatus::kFrame) read.frame.camera = *taken_;
  return read;
}

void Source::TakeCamera(const py::tuple& camera) {
  const depth::Camera taken = CameraFrom(camera);
  Locked([&](auto&) {
    taken_ = taken;
    return true;
  });
}

py::tuple Source::Read(int timeout_ms) {
  depth::ReadResult read;
  {
    const GilReleased free;
    read = Next(timeout_ms);
  }
  if (read.status != depth::ReadStatus::kFrame) {
    return py::make_tuple(NameOf(read.status), py::none(), py::none(), 0.0, read.dropped);
  }
  const depth::Camera& camera = read.frame.camera;
  return py::make_tuple(NameOf(read.status),
                        ToArray(std::move(read.frame.depth_mm), {camera.height, camera.width}),
                        ToTuple(camera), read.frame.time_s, read.dropped);
}

void Source::Close() {
  const GilReleased free;
  const std::lock_guard lock(mutex_);
  frames_.reset();
}

void AddSources(py::module_& module) {
  module.def(
      "preset_camera",
      [](const std::string& name, int width, int height) {
        return ToTuple(depth::PresetCamera(name, width, height));
      },
      py::arg("name"), py::arg("width"), py::arg("height"));
  module.def(
      "parse_camera",
      [](const std::string& text, int width, int height) {
        return ToTuple(depth::CameraForSize(depth::ParseCamera(text), width, height));
      },
      py::arg("text"), py::arg("width"), py::arg("height"));
  py::class_<Source>(module, "Source")
      .def(py::init<const std::string&, const py::dict&>(), py::arg("name"), py::arg("options"))
      .def("read", &Source::Read, py::arg("timeout_ms"))
      .def("close", &Source::Close)
      .def("camera", &Source::Camera)
      .def("is_live", &Source::IsLive)
      .def("frame_count", &Source::FrameCount)
      .def("take_camera", &Source::TakeCamera, py::arg("camera"))
      .def("take_notes", &Source::TakeNotes);
}

}  // namespace ossa::python
