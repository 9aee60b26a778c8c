#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

#include "depth/sensor/frame_source.h"
#include "recon/methods/reconstructor.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/model_set.h"

/// The extension module ossa._native on which the package's Python files are built. Its functions
/// take and return plain arrays, numbers, strings and dicts; the Python files check types and have
/// the documentation.
namespace ossa::python {

namespace py = pybind11;

void AddSources(py::module_& module);
void AddTracker(py::module_& module);
void AddForest(py::module_& module);
void AddSkeletons(py::module_& module);
void AddLearning(py::module_& module);

/// Releases the GIL during its lifetime. A daemon thread that requests the GIL while the
/// interpreter ends is made to exit by Python, through C++ frames, which aborts the process. Such a
/// thread waits for the process's end instead, as in Python 3.14.
class GilReleased {
 public:
  GilReleased() : state_(PyEval_SaveThread()) {}
  ~GilReleased();
  GilReleased(const GilReleased&) = delete;
  GilReleased& operator=(const GilReleased&) = delete;

 private:
  PyThreadState* state_;
};

/// False once Python has a pending signal (Ctrl-C): a long run then stops. Called without the GIL,
/// within Interruptible().
bool CheckSignals();
/// The same, and the result of the Python function `ask`, called without arguments. Its exceptions
/// also end the run.
bool CheckSignalsAndAsk(PyObject* ask);
/// Throws the Python exception that was raised meanwhile, if any.
void ThrowIfInterrupted();

/// Runs `work` without the GIL and returns its result. If CheckSignals() ended it, throws the
/// Python exception, whatever the work returned or threw: KeyboardInterrupt must not become "no
/// device found".
template <typename Work>
std::invoke_result_t<Work> Interruptible(const Work& work) {
  try {
    auto made = [&] {
      const GilReleased free;
      return work();
    }();
    ThrowIfInterrupted();
    return made;
  } catch (...) {
    ThrowIfInterrupted();
    throw;
  }
}

/// The options of single methods by their keywords (ossa/_method_options.py).
struct MethodOptions {
  recon::LocalPcaOptions local_pca;
  recon::GaussianProcessOptions gaussian_process;
  recon::BestOptions best;
};
MethodOptions ReadMethodOptions(const py::dict& given);
/// forest, refinement, learned, prior, database.
tracker::ModelFiles ReadModelFiles(const py::dict& given);
/// camera, depth_scale, depth_format, fps, mirrored, wait_s, keep_waiting. `given` must outlive
/// them.
depth::SourceOptions ReadSourceOptions(const py::dict& given);
/// motors, hinges, joint_limits.
tracker::MechanicsBuild ReadMechanics(const py::dict& given);

}  // namespace ossa::python
