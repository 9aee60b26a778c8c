#include <pybind11/stl.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "depth/base/error.h"
#include "depth/base/one_line.h"
#include "depth/image/camera_presets.h"
#include "recon/body/parts.h"
#include "recon/files/skeleton_io.h"
#include "recon/methods/method_table.h"
#include "tools/python/native/native.h"
#include "tools/tracker/smoothing.h"
#include "tools/tracker/tracker.h"

namespace ossa::python {
namespace {

template <typename Names>
py::tuple NamesOf(const Names& names) {
  py::list list;
  for (const auto& name : names) list.append(std::string(name));
  return py::tuple(list);
}

// Translates errors in arguments and files to InputError; pybind11 translates the others.
void AddErrors(py::module_& module) {
  static const py::object input_error =
      py::exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception_translator([](std::exception_ptr pointer) {
    const auto raise = [](const char* what) {
      PyErr_SetString(input_error.ptr(), OnOneLine(what).c_str());
    };
    try {
      if (pointer) std::rethrow_exception(pointer);
    } catch (const InputError& error) {
      raise(error.what());
    } catch (const std::invalid_argument& error) {
      raise(error.what());
    } catch (const std::filesystem::filesystem_error& error) {
      raise(error.what());
    }
  });
}

py::tuple MethodTable() {
  py::list table;
  for (const recon::MethodInfo& info : recon::MethodTable()) {
    py::dict row;
    row["name"] = std::string(info.name);
    row["database"] = static_cast<int>(info.database);
    row["learned"] = static_cast<int>(info.learned);
    row["prior"] = info.prior;
    row["refined"] = info.refined;
    row["keeps_bones"] = info.keeps_bones;
    row["smoothing"] = std::string(info.smoothing);
    table.append(row);
  }
  return py::tuple(table);
}

// Sets the members of an Options struct that the dict contains.
struct Reader {
  const py::dict& given;
  template <typename T>
  void operator()(const char* name, T& value) const {
    if (given.contains(name)) value = given[name].cast<T>();
  }
};

// A thread that Python makes exit stays in this handler.
[[noreturn]] void WaitForTheEnd() {
  for (;;) pause();
}

}  // namespace

GilReleased::~GilReleased() {
  try {
    PyEval_RestoreThread(state_);
  } catch (...) {  // the thread's exit: Python throws nothing else here
    WaitForTheEnd();
  }
}

bool CheckSignals() {
  try {
    const py::gil_scoped_acquire gil;
    // Python reports a signal once: later calls must return false, too.
    return PyErr_Occurred() == nullptr && PyErr_CheckSignals() == 0;
  } catch (...) {  // likewise
    WaitForTheEnd();
  }
}

bool CheckSignalsAndAsk(PyObject* ask) {
  if (!CheckSignals()) return false;
  try {
    const py::gil_scoped_acquire gil;
    const auto answer = py::reinterpret_steal<py::object>(PyObject_CallNoArgs(ask));
    return answer && PyObject_IsTrue(answer.ptr()) == 1;
  } catch (...) {  // likewise
    WaitForTheEnd();
  }
}

void ThrowIfInterrupted() {
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
}

MethodOptions ReadMethodOptions(const py::dict& given) {
  const Reader read{given};
  MethodOptions options;
  recon::LocalPcaOptions& pca = options.local_pca;
  read("neighbours", pca.neighbours);
  read("dimensions", pca.dimensions);
  read("steps", pca.steps);
  read("samples", pca.samples);
  read("solver", pca.solver);
  read("use_reliability", pca.use_reliability);
  read("keep_reliable", pca.keep_reliable);
  read("extend_database", pca.extend_database);
  read("control_weight", pca.control);
  read("style", pca.style);
  read("kinematics", pca.kinematics);
  read("continuity", pca.continuity);
  recon::GaussianProcessOptions& gaussian = options.gaussian_process;
  read("nearby_models", gaussian.nearby_models);
  read("incremental", gaussian.incremental);
  read("spatial", gaussian.spatial);
  read("temporal", gaussian.temporal);
  read("reliability", gaussian.reliability);
  recon::BestOptions& best = options.best;
  read("repair", best.repair);
  read("complete", best.complete);
  read("correct", best.correct);
  read("filter", best.filter);
  read("constant_bones", best.bones);
  return options;
}

tracker::ModelFiles ReadModelFiles(const py::dict& given) {
  using Files = tracker::ModelFiles;
  static constexpr std::pair<const char*, std::string Files::*> kFiles[] = {
      {"forest", &Files::forest},
      {"refinement", &Files::refinement},
      {"pose_network", &Files::pose_network},
      {"surface", &Files::surface},
      {"learned", &Files::learned},
      {"prior", &Files::prior},
      {"database", &Files::database}};
  Files files;
  for (const auto& [name, file] : kFiles) Reader{given}(name, files.*file);
  return files;
}

tracker::MechanicsBuild ReadMechanics(const py::dict& given) {
  const Reader read{given};
  tracker::MechanicsBuild build;
  read("motors", build.motors);
  read("hinges", build.hinges);
  read("joint_limits", build.joint_limits);
  return build;
}

}  // namespace ossa::python

PYBIND11_MODULE(_native, module) {
  using namespace ossa;
  python::AddErrors(module);
  module.attr("version") = tracker::Version();
  module.attr("joints") = python::NamesOf(recon::kJointNames);
  module.attr("parents") = pybind11::tuple(
      pybind11::cast(std::vector<int>(recon::kJointParent.begin(), recon::kJointParent.end())));
  module.attr("parts") = python::NamesOf(recon::kPartNames);
  module.attr("methods") = python::MethodTable();
  module.attr("camera_presets") = python::NamesOf(depth::CameraPresetNames());
  module.attr("smoothing_presets") = python::NamesOf(tracker::SmoothingPresets());
  module.attr("skeleton_formats") = python::NamesOf(recon::SkeletonFormats());
  python::AddSources(module);
  python::AddTracker(module);
  python::AddForest(module);
  python::AddSkeletons(module);
  python::AddLearning(module);
}
