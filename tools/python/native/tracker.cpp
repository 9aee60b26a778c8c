// ossa.Tracker.
#include "tools/tracker/tracker.h"

#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "depth/sensor/frame_source.h"
#include "tools/python/native/arrays.h"
#include "tools/python/native/body_frames.h"
#include "tools/python/native/native.h"
#include "tools/python/native/source.h"
#include "tools/python/native/tracker_options.h"
#include "tools/tracker/body_mesh_file.h"
#include "tools/tracker/camera_search.h"

namespace ossa::python {
namespace {

using tracker::BodyFrame;

/// All models in memory, shared by any number of trackers.
struct Models {
  tracker::ModelSet set;
  std::string method;
  MeshPointer mesh;  // of `set.surface`; null without one
};

Models LoadModels(const py::dict& files, const std::string& method) {
  const tracker::ModelFiles named = ReadModelFiles(files);
  const auto mesh = files["mesh"].cast<std::string>();
  const GilReleased free;
  Models models{tracker::ModelSet::Load(named, method), method, nullptr};
  if (models.set.surface) models.mesh = tracker::LoadBodyMesh(named.surface, mesh);
  return models;
}

/// A tracker that one thread at a time may use; others wait.
class Tracker {
 public:
  Tracker(const py::dict& given, const Models& models) : method_(models.method) {
    tracker::TrackerOptions options = ReadTrackerOptions(given);
    options.models = models.set;
    options.shapes =
        LoadPeople(given["person"].cast<std::vector<std::string>>(), models.set.surface.get());
    with_proposals_ = options.keep_proposals;
    options_ = options;
    const GilReleased free;
    tracker_.emplace(options);
    if (options.fit) mesh_ = models.mesh;
  }

  py::dict Track(const py::array& depth_mm, const py::tuple& camera, double time_s, int turn) {
    BodyFrame bodies;
    WithFrame(depth_mm, camera, time_s, turn,
              [&](const depth::DepthFrame& frame) { bodies = tracker_->Track(frame); });
    return ToDict(std::move(bodies), with_proposals_, mesh_);
  }

  /// Triangles of the mesh; None without a fit.
  py::object Faces() const {
    return mesh_ ? py::object(ToArray(mesh_->triangles)) : py::object(py::none());
  }

  /// None until as many images have arrived as the lag has frames.
  py::object TrackWithLag(const py::array& depth_mm, const py::tuple& camera, double time_s,
                          int turn) {
    std::optional<BodyFrame> bodies;
    WithFrame(depth_mm, camera, time_s, turn,
              [&](const depth::DepthFrame& frame) { bodies = tracker_->TrackWithLag(frame); });
    return OrNone(std::move(bodies));
  }

  /// Reads and tracks the next image of a source without a copy: (status, None or as TrackWithLag,
  /// time_s, dropped).
  py::tuple TrackNext(Source& source, int timeout_ms, int turn) {
    depth::ReadResult read;
    std::optional<BodyFrame> bodies;
    {
      const GilReleased free;
      read = source.Next(timeout_ms);
      if (read.status == depth::ReadStatus::kFrame) {
        const std::lock_guard lock(mutex_);
        tracker_->SetTurn(static_cast<tracker::Turn>(turn));
        read.frame.index = index_;
        bodies = tracker_->TrackWithLag(read.frame);
        ++index_;
      }
    }
    return py::make_tuple(NameOf(read.status), OrNone(std::move(bodies)), read.frame.time_s,
                          read.dropped);
  }

  /// None if no frame is left.
  py::object DrainLag() {
    std::optional<BodyFrame> bodies;
    Locked([&](tracker::Tracker& t) { bodies = t.DrainLag(); });
    return OrNone(std::move(bodies));
  }

  /// For images without a stated camera: (camera, description) if the estimated camera differs from
  /// the guess.
  py::object FindCamera(const std::string& source, const py::dict& given) {
    const depth::SourceOptions options = ReadSourceOptions(given);
    const auto finding = Interruptible([&] {
      return tracker::FindNarrowerCamera(
          source, options, [this] { return options_; }, CheckSignals);
    });
    if (!finding) return py::none();
    return py::make_tuple(ToTuple(finding->found.camera), tracker::Describe(*finding));
  }

  /// Determines from the beginning of a recording which way up its camera is.
  int FindUpright(const std::string& source, const py::dict& given) {
    const depth::SourceOptions options = ReadSourceOptions(given);
    return Interruptible([&] {
      const std::lock_guard lock(mutex_);
      tracker_->SetTurn(tracker::Turn::kAuto);
      tracker_->FindUpright(*depth::OpenSource(source, options), CheckSignals);
      return tracker_->quarter_turns();
    });
  }

  std::optional<std::string> TakeWarning() {
    std::optional<std::string> warning;
    Locked([&](tracker::Tracker& t) { warning = t.TakeWarning(); });
    return warning;
  }
  void ChooseUsers(const std::optional<std::vector<int>>& ids) {
    Locked([&](tracker::Tracker& t) { ids ? t.ChooseUsers(*ids) : t.ChooseAllUsers(); });
  }
  void SetSeated(bool seated) {
    using tracker::TrackingMode;
    Locked([&](tracker::Tracker& t) {
      t.SetMode(seated ? TrackingMode::kSeated : TrackingMode::kStanding);
    });
  }
  void SetSmoothing(const py::object& given) {
    const tracker::SmoothingOptions options = ReadSmoothing(given, method_);
    Locked([&](tracker::Tracker& t) { t.SetSmoothing(options); });
  }
  int QuarterTurns() {
    int turns = 0;
    Locked([&](tracker::Tracker& t) { turns = t.quarter_turns(); });
    return turns;
  }
  void Reset() {
    Locked([&](tracker::Tracker& t) { t.Reset(); });
  }

 private:
  py::object OrNone(std::optional<BodyFrame> bodies) const {
    if (!bodies) return py::none();
    return ToDict(std::move(*bodies), with_proposals_, mesh_);
  }

  /// Calls `track` with a view of the image.
  template <typename Track>
  void WithFrame(const py::array& depth_mm, const py::tuple& camera, double time_s, int turn,
                 const Track& track) {
    depth::DepthFrame frame;
    frame.borrowed = ToView(depth_mm);
    frame.camera = ToCamera(camera, frame.borrowed);
    frame.time_s = time_s;
    const GilReleased free;
    const std::lock_guard lock(mutex_);
    tracker_->SetTurn(static_cast<tracker::Turn>(turn));
    frame.index = index_;
    track(frame);
    ++index_;
  }

  template <typename Change>
  void Locked(const Change& change) {
    const GilReleased free;
    const std::lock_guard lock(mutex_);
    change(*tracker_);
  }

  std::mutex mutex_;
  std::string method_;
  bool with_proposals_ = false;
  MeshPointer mesh_;   // null without a surface fit
  int64_t index_ = 0;  // of the next image
  tracker::TrackerOptions options_;
  std::optional<tracker::Tracker> tracker_;
};

}  // namespace

void AddTracker(py::module_& module) {
  py::class_<Models>(module, "Models")
      .def(py::init(&LoadModels), py::arg("files"), py::arg("method"))
      .def_readonly("method", &Models::method)
      .def_property_readonly("warnings", [](const Models& models) { return models.set.warnings; });
  py::class_<Skin>(module, "Skin")
      .def("vertices", &ComputeVertices)
      // Immutable: dataclasses.asdict and copy.deepcopy may share it.
      .def(
          "__deepcopy__", [](const py::object& self, const py::dict&) { return self; },
          py::arg("memo"));
  py::class_<Tracker>(module, "Tracker")
      .def(py::init<const py::dict&, const Models&>(), py::arg("options"), py::arg("models"))
      .def("track", &Tracker::Track, py::arg("depth_mm"), py::arg("camera"), py::arg("time_s"),
           py::arg("turn"))
      .def("faces", &Tracker::Faces)
      .def("track_late", &Tracker::TrackWithLag, py::arg("depth_mm"), py::arg("camera"),
           py::arg("time_s"), py::arg("turn"))
      .def("track_next", &Tracker::TrackNext, py::arg("source"), py::arg("timeout_ms"),
           py::arg("turn"))
      .def("take_held", &Tracker::DrainLag)
      .def("find_camera", &Tracker::FindCamera, py::arg("source"), py::arg("options"))
      .def("find_upright", &Tracker::FindUpright, py::arg("source"), py::arg("options"))
      .def("take_warning", &Tracker::TakeWarning)
      .def("choose_users", &Tracker::ChooseUsers, py::arg("ids"))
      .def("set_seated", &Tracker::SetSeated, py::arg("seated"))
      .def("set_smoothing", &Tracker::SetSmoothing, py::arg("smoothing"))
      .def("quarter_turns", &Tracker::QuarterTurns)
      .def("reset", &Tracker::Reset);
}

}  // namespace ossa::python
