#pragma once
#include <pybind11/pybind11.h>

#include <string>
#include <type_traits>

#include "depth/sensor/frame_source.h"
#include "recon/methods/reconstructor.h"
#include "tools/tracker/mechanics.h"
#include "tools/tracker/model_set.h"

/// The extension module ossa._native: what the package's Python files are written over. Its
/// functions take and give plain arrays, numbers, texts and dicts; the Python files check types,
/// name things and explain them.
namespace ossa::python {

namespace py = pybind11;

void AddSources(py::module_& module);
void AddTracker(py::module_& module);
void AddForest(py::module_& module);
void AddSkeletons(py::module_& module);
void AddLearning(py::module_& module);

/// The GIL let go of for as long as this lives. Once the interpreter ends, a daemon thread cannot
/// have it back: Python makes it exit where it asks, through frames of C++ that cannot be left so,
/// and the process would abort. It waits for the process's end instead, as from Python 3.14 on.
class GilReleased {
 public:
  GilReleased() : state_(PyEval_SaveThread()) {}
  ~GilReleased();
  GilReleased(const GilReleased&) = delete;
  GilReleased& operator=(const GilReleased&) = delete;

 private:
  PyThreadState* state_;
};

/// Whether a long run goes on: false once Python has a signal to act on (Ctrl-C). Called without
/// the GIL, within Interruptible.
bool CheckSignals();
/// The same, and whether the Python function `ask` says so, which is called without arguments. What
/// it raises ends the run, too.
bool CheckSignalsAndAsk(PyObject* ask);
/// Throws what Python raised meanwhile.
void ThrowIfInterrupted();

/// What `work` returns, done without the GIL. Where CheckSignals ended it, what Python raised is
/// thrown, whatever the work returned or threw then: KeyboardInterrupt must not become "no device
/// found".
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
