// ossa.Tracker.
#include "tools/tracker/tracker.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "depth/sensor/frame_source.h"
#include "tools/python/native/arrays.h"
#include "tools/python/native/native.h"
#include "tools/python/native/source.h"
#include "tools/tracker/body_mesh_file.h"
#include "tools/tracker/camera_search.h"

namespace ossa::python {
namespace {

using tracker::Body;
using tracker::BodyFrame;

py::object TextOrNone(const py::dict& given, const char* key) {
  return given.contains(key) ? py::object(given[key]) : py::none();
}

tracker::SmoothingOptions SmoothingFrom(const py::object& given, const std::string& method) {
  if (given.is_none()) return tracker::SmoothingPreset(recon::RequireMethod(method).smoothing);
  if (py::isinstance<py::str>(given)) return tracker::SmoothingPreset(given.cast<std::string>());
  const auto values = given.cast<py::dict>();
  const auto number = [&](const char* key) { return values[key].cast<double>(); };
  tracker::SmoothingOptions options;
  if (values.contains("min_cutoff_hz")) {
    options.kind = tracker::SmoothingKind::kOneEuro;
    options.one_euro.min_cutoff_hz = number("min_cutoff_hz");
    options.one_euro.beta_per_m = number("beta_per_m");
    return options;
  }
  options.holt.smoothing = number("smoothing");
  options.holt.correction = number("correction");
  options.holt.prediction = number("prediction");
  options.holt.jitter_radius_m = number("jitter_radius_m");
  options.holt.max_deviation_radius_m = number("max_deviation_radius_m");
  return options;
}

tracker::TrackerOptions OptionsFrom(const py::dict& given) {
  tracker::TrackerOptions options;
  const auto flag = [&](const char* key) { return given[key].cast<bool>(); };
  options.method = given["method"].cast<std::string>();
  options.physics = flag("physics");
  if (!flag("fit")) options.fit.reset();
  options.mechanics = ReadMechanics(given["mechanics"].cast<py::dict>());
  const MethodOptions of_method = ReadMethodOptions(given["method_options"].cast<py::dict>());
  options.local_pca = of_method.local_pca;
  options.gaussian_process = of_method.gaussian_process;
  options.best = of_method.best;
  options.smoothing = SmoothingFrom(TextOrNone(given, "smoothing"), options.method);
  if (flag("seated")) options.mode = tracker::TrackingMode::kSeated;
  options.near_range = flag("near");
  options.lag = given["lag"].cast<int>();
  options.max_users = given["max_users"].cast<int>();
  options.threads = given["threads"].cast<int>();
  options.seed = given["seed"].cast<uint64_t>();
  options.keep_parts = flag("parts");
  options.keep_probabilities = flag("probabilities");
  options.keep_proposals = flag("proposals");
  for (const auto& [id, lengths] : given["bones_m"].cast<std::map<int, std::vector<double>>>()) {
    recon::BoneLengths bones{};
    std::copy_n(lengths.begin(), bones.size(), bones.begin());
    options.bones_m[id] = bones;
  }
  const auto mount = given["mount"].cast<std::string>();
  if (mount == "level") options.mount = tracker::Mount::kLevel;
  if (mount == "ceiling") options.mount = tracker::Mount::kCeiling;
  if (const auto scene = given["scene"].cast<std::string>(); !scene.empty()) {
    options.scene = tracker::LoadScene(scene);
    options.scene->people = options.mechanics;
  }
  return options;
}

// Body ids in the order of the files.
std::map<int, recon::PersonShape> LoadPeople(const std::vector<std::string>& paths,
                                             const recon::BodySurface* surface) {
  if (!paths.empty() && surface == nullptr) {
    throw InputError("person: expected models with a body surface");
  }
  std::map<int, recon::PersonShape> people;
  int id = 0;
  for (const std::string& path : paths) people[++id] = recon::PersonShape::Load(path, *surface);
  return people;
}

/// All models in memory, shared by any number of trackers.
struct Models {
  tracker::ModelSet set;
  std::string method;
  std::shared_ptr<const recon::BodyMesh> mesh;  // of `set.surface`; null without one
};

Models LoadModels(const py::dict& files, const std::string& method) {
  const tracker::ModelFiles named = ReadModelFiles(files);
  const auto mesh = files["mesh"].cast<std::string>();
  const GilReleased free;
  Models models{tracker::ModelSet::Load(named, method), method, nullptr};
  if (models.set.surface) models.mesh = tracker::LoadBodyMesh(named.surface, mesh);
  return models;
}

// float64 [n, 5]: x y z, confidence, seen.
py::array_t<double> ToArray(const std::vector<tracker::JointProposal>& proposals) {
  std::vector<double> values;
  for (const tracker::JointProposal& p : proposals) {
    values.insert(values.end(), p.position_m.begin(), p.position_m.end());
    values.insert(values.end(), {p.confidence, p.seen ? 1.0 : 0.0});
  }
  return python::ToArray(std::move(values), {static_cast<py::ssize_t>(proposals.size()), 5});
}

py::object ToArray(const std::optional<recon::BoneLengths>& bones_m) {
  return bones_m ? py::object(python::ToArray(*bones_m)) : py::none();
}

recon::JointArray<double> ConfidenceOf(const Body& body) {
  recon::JointArray<double> confidence;
  for (size_t j = 0; j < confidence.size(); ++j) confidence[j] = body.joints[j].confidence;
  return confidence;
}

using MeshPointer = std::shared_ptr<const recon::BodyMesh>;

py::array ComputeVertices(const recon::BodyMesh& mesh, const recon::SurfacePose& pose) {
  std::vector<double> vertices_m;
  for (const Eigen::Vector3d& place_m : recon::PoseMesh(mesh, pose)) {
    vertices_m.insert(vertices_m.end(), place_m.begin(), place_m.end());
  }
  const auto count = static_cast<py::ssize_t>(vertices_m.size() / 3);
  return python::ToArray(std::move(vertices_m), {count, 3});
}

// The skin of a body, posed on request. It is an object because creating a function for each body
// would take longer than the rest of the conversion.
struct Skin {
  MeshPointer mesh;
  recon::SurfacePose pose;
};

py::dict ToDict(const recon::SurfaceFit& fit, const MeshPointer& mesh) {
  constexpr py::ssize_t kSegments = recon::kSegmentCount;
  std::vector<double> turns, residuals_m;
  for (const Eigen::Quaterniond& q : fit.camera_from_segment) {
    turns.insert(turns.end(), {q.w(), q.x(), q.y(), q.z()});
  }
  for (const auto& residual_m : fit.residual_m) {
    residuals_m.push_back(residual_m.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  const auto& shape = fit.pose.shape;
  py::dict made;
  made["joints"] = python::ToArray(fit.joints_m);
  made["shape"] =
      python::ToArray(std::vector<double>(shape.begin(), shape.end()), {recon::kShapeCount});
  made["stature_m"] = fit.stature_m;
  std::vector<double> covariance_m2;
  for (const Eigen::Matrix3d& of_joint : fit.covariance_m2) {
    covariance_m2.insert(covariance_m2.end(), of_joint.data(), of_joint.data() + of_joint.size());
  }
  made["covariance_m2"] = python::ToArray(std::move(covariance_m2),
                                          {static_cast<py::ssize_t>(recon::kJointCount), 3, 3});
  made["explained"] = fit.explained;
  made["score"] = fit.score;
  made["median_residual_m"] = fit.median_residual_m;
  made["residuals_m"] = python::ToArray(std::move(residuals_m), {kSegments});
  made["orientations"] = python::ToArray(std::move(turns), {kSegments, 4});
  made["_skin"] = Skin{mesh, fit.pose};
  return made;
}

// Vertex indices, int32 [f, 3].
py::array_t<int32_t> ToArray(const std::vector<recon::MeshTriangle>& triangles) {
  std::vector<int32_t> corners;
  for (const recon::MeshTriangle& triangle : triangles) {
    for (const uint32_t corner : triangle) corners.push_back(static_cast<int32_t>(corner));
  }
  return python::ToArray(std::move(corners), {static_cast<py::ssize_t>(triangles.size()), 3});
}

// The fields of a tracked body besides joints and id.
void AddSkeleton(const Body& body, bool with_proposals, py::dict& made) {
  recon::JointArray<recon::TrackingState> states;
  recon::JointArray<double> reliability;
  recon::JointOrientations orientations;
  for (size_t j = 0; j < recon::kJointCount; ++j) {
    states[j] = body.joints[j].state;
    reliability[j] = body.joints[j].reliability;
    orientations[j] = body.joints[j].orientation;
  }
  made["joints"] = python::ToArray(tracker::ToPosture(body));
  made["states"] = python::ToArray(states);
  made["confidence"] = python::ToArray(ConfidenceOf(body));
  made["reliability"] = python::ToArray(reliability);
  made["orientations"] = python::ToArray(orientations);
  made["hierarchical_orientations"] =
      python::ToArray(tracker::ComputeHierarchicalOrientations(body));
  made["raw"] = python::ToArray(body.raw.posture);
  made["refined"] = body.refined ? py::object(python::ToArray(*body.refined)) : py::none();
  made["reconstructed"] = python::ToArray(body.reconstructed);
  made["bones_m"] = ToArray(body.bones_m);
  if (!with_proposals) return;
  py::list proposals;
  for (const auto& of_joint : body.proposals) proposals.append(ToArray(of_joint));
  made["proposals"] = proposals;
}

py::dict ToDict(const Body& body, bool with_proposals, const MeshPointer& mesh) {
  py::dict made;
  made["id"] = body.id;
  made["tracked"] = body.state == tracker::BodyState::kTracked;
  made["position"] =
      python::ToArray(std::vector<double>(body.position_m.begin(), body.position_m.end()), {3});
  made["clipped_edges"] = body.clipped_edges;
  made["person_score"] = body.person_score;
  if (body.state == tracker::BodyState::kTracked) AddSkeleton(body, with_proposals, made);
  if (body.fit && mesh) made["fit"] = ToDict(*body.fit, mesh);
  return made;
}

py::object ToArray(depth::Image<uint8_t> image) {
  if (image.data.empty()) return py::none();
  return python::ToArray(std::move(image.data), {image.height, image.width});
}

py::dict ToDict(const tracker::StageTimes& ms) {
  py::dict made;
  made["segment"] = ms.segment;
  made["classify"] = ms.classify;
  made["propose"] = ms.propose;
  made["reconstruct"] = ms.reconstruct;
  made["physics"] = ms.physics;
  made["fit"] = ms.fit;
  made["total"] = ms.total;
  return made;
}

py::dict ToDict(const tracker::SceneObjectState& object) {
  py::dict made;
  const auto array = [](const Eigen::Vector3d& v) {
    return python::ToArray(std::vector<double>(v.begin(), v.end()), {3});
  };
  const Eigen::Quaterniond& q = object.orientation;
  made["name"] = object.name;
  made["position"] = array(object.position_m);
  made["orientation"] = python::ToArray(std::vector<double>{q.w(), q.x(), q.y(), q.z()}, {4});
  made["velocity_m_s"] = array(object.velocity_m_s);
  made["held_by"] = py::tuple(py::cast(object.held_by));
  return made;
}

py::dict ToDict(BodyFrame frame, bool with_proposals, const MeshPointer& mesh) {
  py::dict made;
  py::list bodies, objects;
  for (const auto& object : frame.objects) objects.append(ToDict(object));
  made["objects"] = objects;
  for (const Body& body : frame.bodies) bodies.append(ToDict(body, with_proposals, mesh));
  made["index"] = frame.index;
  made["time_s"] = frame.time_s;
  made["bodies"] = bodies;
  made["users"] = ToArray(std::move(frame.users));
  made["parts"] = ToArray(std::move(frame.parts));
  tracker::PartProbabilities& p = frame.probabilities;
  made["probabilities"] = p.data.empty()
                              ? py::object(py::none())
                              : python::ToArray(std::move(p.data), {p.height, p.width, p.classes});
  made["floor"] = frame.floor
                      ? py::object(python::ToArray(
                            std::vector<double>(frame.floor->begin(), frame.floor->end()), {4}))
                      : py::none();
  made["tilt_down_rad"] = frame.tilt_down_rad;
  made["ms"] = ToDict(frame.ms);
  return made;
}

/// A tracker that one thread at a time may use; others wait.
class Tracker {
 public:
  Tracker(const py::dict& given, const Models& models) : method_(models.method) {
    tracker::TrackerOptions options = OptionsFrom(given);
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
    const tracker::SmoothingOptions options = SmoothingFrom(given, method_);
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
  std::shared_ptr<const recon::BodyMesh> mesh_;  // null without a surface fit
  int64_t index_ = 0;                            // of the next image
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
      .def("vertices", [](const Skin& skin) { return ComputeVertices(*skin.mesh, skin.pose); })
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
