// ossa.Sequence, its files, and methods over it.
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "depth/base/error.h"
#include "recon/database/posture_database.h"
#include "recon/files/skeleton_io.h"
#include "recon/files/skeleton_writer.h"
#include "recon/filters/butterworth.h"
#include "recon/filters/lag_smoothing.h"
#include "recon/methods/reconstruct_sequence.h"
#include "recon/models/learned_models.h"
#include "recon/models/posture_prior.h"
#include "tools/python/native/arrays.h"
#include "tools/python/native/native.h"
#include "tools/tracker/body_mesh_file.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/shipped.h"

namespace ossa::python {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int8_t kUnknownValue = -1;  // by definition: state or visibility that no file contains
constexpr int64_t kNobody = -1;       // by definition: id of the row of a frame without bodies

/// The columns of a Sequence: one row per body of each frame, and one row for a frame without
/// bodies.
struct Columns {
  std::vector<int64_t> frames, ids;
  std::vector<double> times, floors, joints, confidence, reliability, orientations, bones_m;
  std::vector<int8_t> states, visible;

  void AddMoment(const recon::SkeletonFrame& frame, int64_t id) {
    frames.push_back(frame.frame);
    times.push_back(frame.time_s);
    ids.push_back(id);
    for (int i = 0; i < 4; ++i) floors.push_back(frame.floor ? (*frame.floor)[i] : kNone);
  }
  void AddJoint(const std::optional<recon::JointRecord>& joint) {
    const auto value = [&](const std::optional<double> recon::JointRecord::*member) {
      return joint && (*joint).*member ? *((*joint).*member) : kNone;
    };
    for (int i = 0; i < 3; ++i) joints.push_back(joint ? joint->position_m[i] : kNone);
    const bool turned = joint && joint->orientation;
    const Eigen::Quaterniond q = turned ? *joint->orientation : Eigen::Quaterniond::Identity();
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) {
      orientations.push_back(turned ? part : kNone);
    }
    confidence.push_back(value(&recon::JointRecord::confidence));
    reliability.push_back(value(&recon::JointRecord::reliability));
    states.push_back(joint && joint->state ? static_cast<int8_t>(*joint->state) : kUnknownValue);
    visible.push_back(joint && joint->visible ? static_cast<int8_t>(*joint->visible)
                                              : kUnknownValue);
  }
  void AddBody(const recon::BodyRecord& body) {
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      AddJoint(body.joints[j]);
      bones_m.push_back(body.bones_m ? (*body.bones_m)[j] : kNone);
    }
  }
};

py::dict ToDict(const recon::SkeletonSequence& sequence) {
  Columns columns;
  for (const recon::SkeletonFrame& frame : sequence.frames) {
    for (const recon::BodyRecord& body : frame.bodies) {
      columns.AddMoment(frame, body.id);
      columns.AddBody(body);
    }
    if (!frame.bodies.empty()) continue;
    columns.AddMoment(frame, kNobody);
    columns.AddBody({});
  }
  const auto rows = static_cast<py::ssize_t>(columns.frames.size());
  constexpr py::ssize_t kJoints = recon::kJointCount;
  py::dict made;
  made["source"] = sequence.source;
  made["sensor"] = sequence.sensor;
  made["columns"] = sequence.columns;
  made["warnings"] = sequence.warnings;
  made["frames"] = ToArray(std::move(columns.frames), {rows});
  made["ids"] = ToArray(std::move(columns.ids), {rows});
  made["times"] = ToArray(std::move(columns.times), {rows});
  made["floor"] = ToArray(std::move(columns.floors), {rows, 4});
  made["joints"] = ToArray(std::move(columns.joints), {rows, kJoints, 3});
  made["states"] = ToArray(std::move(columns.states), {rows, kJoints});
  made["confidence"] = ToArray(std::move(columns.confidence), {rows, kJoints});
  made["reliability"] = ToArray(std::move(columns.reliability), {rows, kJoints});
  made["orientations"] = ToArray(std::move(columns.orientations), {rows, kJoints, 4});
  made["visible"] = ToArray(std::move(columns.visible), {rows, kJoints});
  made["bones_m"] = ToArray(std::move(columns.bones_m), {rows, kJoints});
  return made;
}

template <typename T>
using Contiguous = py::array_t<T, py::array::c_style | py::array::forcecast>;

/// The rows of a Sequence, checked and arranged by the Python files.
class Rows {
 public:
  explicit Rows(const py::dict& given)
      : frames(given["frames"]),
        ids(given["ids"]),
        times(given["times"]),
        floors(given["floor"]),
        joints(given["joints"]),
        confidence(given["confidence"]),
        reliability(given["reliability"]),
        orientations(given["orientations"]),
        bones_m(given["bones_m"]),
        states(given["states"]),
        visible(given["visible"]) {}

  recon::SkeletonFrame MomentAt(py::ssize_t row) const {
    recon::SkeletonFrame frame;
    frame.frame = frames.at(row);
    frame.time_s = times.at(row);
    if (std::isfinite(floors.at(row, 0))) {
      frame.floor = Eigen::Vector4d(floors.data(row, 0));
    }
    return frame;
  }
  std::optional<recon::JointRecord> JointAt(py::ssize_t row, py::ssize_t j) const {
    recon::JointRecord joint;
    joint.position_m = Eigen::Vector3d(joints.data(row, j, 0));
    if (!joint.position_m.allFinite()) return std::nullopt;
    const double trust = confidence.at(row, j), reliable = reliability.at(row, j);
    if (std::isfinite(trust)) joint.confidence = trust;
    if (std::isfinite(reliable)) joint.reliability = reliable;
    const int8_t state = states.at(row, j), seen = visible.at(row, j);
    if (state != kUnknownValue) joint.state = static_cast<recon::TrackingState>(state);
    if (seen != kUnknownValue) joint.visible = seen != 0;
    const double* const q = orientations.data(row, j, 0);
    if (std::isfinite(q[0])) joint.orientation = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    return joint;
  }
  recon::BodyRecord BodyAt(py::ssize_t row) const {
    recon::BodyRecord body;
    body.id = static_cast<int>(ids.at(row));
    for (size_t j = 0; j < recon::kJointCount; ++j) {
      body.joints[j] = JointAt(row, static_cast<py::ssize_t>(j));
    }
    const double* const lengths = bones_m.data(row, 0);
    if (std::isfinite(lengths[0])) {
      body.bones_m.emplace();
      std::copy_n(lengths, recon::kJointCount, body.bones_m->begin());
    }
    return body;
  }
  py::ssize_t count() const { return frames.shape(0); }
  bool IsSameMoment(py::ssize_t a, py::ssize_t b) const {
    return frames.at(a) == frames.at(b) && times.at(a) == times.at(b);
  }
  bool IsNobody(py::ssize_t row) const { return ids.at(row) == kNobody; }

 private:
  Contiguous<int64_t> frames, ids;
  Contiguous<double> times, floors, joints, confidence, reliability, orientations, bones_m;
  Contiguous<int8_t> states, visible;
};

recon::SkeletonSequence SequenceFrom(const py::dict& given) {
  recon::SkeletonSequence sequence;
  sequence.source = given["source"].cast<std::string>();
  sequence.sensor = given["sensor"].cast<std::string>();
  sequence.columns = given["columns"].cast<std::string>();
  const Rows rows(given);
  for (py::ssize_t row = 0; row < rows.count(); ++row) {
    if (row == 0 || !rows.IsSameMoment(row, row - 1)) sequence.frames.push_back(rows.MomentAt(row));
    if (!rows.IsNobody(row)) sequence.frames.back().bodies.push_back(rows.BodyAt(row));
  }
  return sequence;
}

recon::SkeletonReadOptions ReadingFrom(const py::dict& given) {
  recon::SkeletonReadOptions reading;
  reading.columns = given["columns"].cast<std::string>();
  reading.format = given["format"].cast<std::string>();
  reading.frame_s = given["frame_s"].cast<double>();
  reading.mapping_file = given["mapping"].cast<std::string>();
  reading.stop = [] { return !CheckSignals(); };
  return reading;
}

// [(name, sequence)]
py::list ReadClips(const std::string& path, const py::dict& given) {
  const recon::SkeletonReadOptions reading = ReadingFrom(given);
  const auto clips = Interruptible([&] { return recon::ReadSkeletonClips(path, reading); });
  py::list made;
  for (const recon::SkeletonClip& clip : clips) {
    made.append(py::make_tuple(clip.name, ToDict(clip.sequence)));
  }
  return made;
}

py::dict ReadOne(const std::string& path, const py::dict& given) {
  const recon::SkeletonReadOptions reading = ReadingFrom(given);
  return ToDict(Interruptible([&] { return recon::ReadSkeletons(path, reading); }));
}

// `shapes`: float64 [recon::kShapeCount] by body id.
void Write(const py::dict& given, const std::string& path, const py::dict& how,
           const std::map<int, std::vector<double>>& shapes) {
  recon::CheckSkeletonExtension(path);
  const recon::SkeletonSequence sequence = SequenceFrom(given);
  const auto text = [&](const char* key) { return how[key].cast<std::string>(); };
  const tracker::WriteChoice choice = {text("names"), text("surface"), text("mesh")};
  const GilReleased free;
  recon::SkeletonWriter writer(path, tracker::LoadWriteOptions(path, choice));
  for (const auto& [id, shape] : shapes) {
    writer.SetShape(id, Eigen::Map<const recon::ShapeVector>(shape.data()));
  }
  for (const recon::SkeletonFrame& frame : sequence.frames) writer.Write(frame);
  writer.Finish();
}

// The shipped correction if the recording comes from a sensor with known errors.
std::string LearnedFile(const std::string& named, const recon::SkeletonSequence& sequence,
                        const recon::MethodInfo& method) {
  if (named == "none" || method.learned == recon::Reads::kNothing) return {};
  if (!named.empty() || method.learned == recon::Reads::kRequired) return named;
  const tracker::KnownSensor* known = tracker::FindKnownSensor(sequence.sensor);
  return known == nullptr ? "" : tracker::ShippedFile(known->correction).string();
}

recon::ReconstructorOptions OptionsFrom(const py::dict& given,
                                        const recon::SkeletonSequence& sequence) {
  const MethodOptions of_method = ReadMethodOptions(given["method_options"].cast<py::dict>());
  const tracker::ModelFiles files = ReadModelFiles(given["files"].cast<py::dict>());
  recon::ReconstructorOptions options;
  options.method = given["method"].cast<std::string>();
  options.seed = given["seed"].cast<uint64_t>();
  options.local_pca = of_method.local_pca;
  options.gaussian_process = of_method.gaussian_process;
  options.best = of_method.best;
  options.best.refined_joints = sequence.sensor == recon::kRefinedJoints;
  options.database = tracker::LoadDatabase(files, options.method);
  options.prior = tracker::LoadPrior(files, options.method);
  options.learned_file = LearnedFile(files.learned, sequence, recon::RequireMethod(options.method));
  return options;
}

recon::SkeletonSequence Reconstructed(const recon::SkeletonSequence& sequence,
                                      const recon::ReconstructorOptions& options,
                                      bool bones_of_recording) {
  const auto goes_on = [](size_t) { return CheckSignals(); };
  recon::BoneLengthsById bones;
  if (bones_of_recording) bones = recon::MeasureBones(sequence, options, goes_on);
  return recon::ReconstructSequence(sequence, options, goes_on, bones);
}

recon::LagOptions LagFrom(const py::object& lag, const std::string& method, bool offline) {
  static constexpr recon::MethodInfo kOffline{};
  const recon::MethodInfo& info = offline ? kOffline : recon::RequireMethod(method);
  const int usual = info.smoothed_in_files ? recon::kWholeRecording : 0;
  return recon::LagOptions::Of(lag.is_none() ? usual : lag.cast<int>(), info.keeps_bones);
}

std::vector<std::string> DescribeOddities(const py::dict& rows) {
  return recon::DescribeOddities(SequenceFrom(rows));
}

py::dict Reconstruct(const py::dict& rows, const py::dict& given) {
  const recon::SkeletonSequence sequence = SequenceFrom(rows);
  const bool offline = given["method"].cast<std::string>() == "butterworth";
  const double cutoff_hz = given["cutoff_hz"].cast<double>();
  const bool bones_of_recording = given["bones"].cast<std::string>() == "recording";
  const bool physics = given["physics"].cast<bool>();
  const tracker::MechanicsBuild build = ReadMechanics(given["mechanics"].cast<py::dict>());
  recon::ReconstructorOptions options;
  if (!offline) options = OptionsFrom(given, sequence);
  const recon::LagOptions lag = LagFrom(given["lag"], options.method, offline);
  return ToDict(Interruptible([&] {
    recon::SkeletonSequence made = offline ? recon::ButterworthSequence(sequence, cutoff_hz)
                                           : Reconstructed(sequence, options, bones_of_recording);
    made = recon::SmoothSequence(made, lag);
    if (physics) tracker::FollowMechanically(made, build, [](size_t) { return CheckSignals(); });
    return made;
  }));
}

}  // namespace

void AddSkeletons(py::module_& module) {
  module.def("read_skeletons", &ReadOne, py::arg("path"), py::arg("options"));
  module.def("read_clips", &ReadClips, py::arg("path"), py::arg("options"));
  module.def("write_skeletons", &Write, py::arg("sequence"), py::arg("path"), py::arg("how"),
             py::arg("shapes"));
  module.def("describe_oddities", &DescribeOddities, py::arg("sequence"));
  module.def("reconstruct", &Reconstruct, py::arg("sequence"), py::arg("options"));
}

}  // namespace ossa::python
